// One simulation of one model. The five functions marked TODO are to be filled in; paper/README.md has the equations.
#pragma once

#include <vector>

#include "mbs/simulation.hpp"

namespace mbs::@NAME@ {

class Stepper final : public Simulation {
 public:
  /// All that can be done once: sizes, patterns, symbolic analysis. A step allocates nothing.
  Stepper(const Model& model, const StepSettings& settings);

 private:
  void do_set_state(const State& state) override;
  void do_get_state(State& state) const override;
  StepOutcome do_step() override;

  void evaluate_constraints();             // TODO: Phi at q
  void evaluate_jacobian();                // TODO: Phi_q at q
  void evaluate_residual();                // TODO: f, Eq. (3)
  void evaluate_tangent();                 // TODO: T, Eq. (5)
  bool solve(std::vector<double>& right);  // TODO: right becomes T^-1 right; false: T was refused

  const Model& model_;
  StepSettings settings_;
  State state_;
};

}  // namespace mbs::@NAME@
