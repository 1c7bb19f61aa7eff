// One simulation of one model. Fill in what is marked TODO; paper/README.md has the equations.
#pragma once

@INCLUDE@#include <vector>

#include "mbs/simulation.hpp"

namespace mbs::@NAME@ {

class Stepper final : public Simulation {
 public:
  /// All that can be done once: sizes, patterns, symbolic analysis. A step allocates nothing.
  Stepper(const Model& model, const StepSettings& settings);

 private:
  void do_set_state(const State& state) override;
  void do_get_state(State& state) const override;
  StepOutcome do_step() override;                    // TODO: the step, of the functions below
  bool do_show_first_pass(FirstPass& pass) override;  // for mbs check --ladder; not part of a step

  // In the order in which the ladder looks at them.
  void predict();                          // TODO: q', v', a' in state_, Eq. (2)
  void evaluate_constraints();             // TODO: Phi at q', Eq. (7)
  void evaluate_jacobian();                // TODO: Phi_q at q', Eq. (7)
  void evaluate_residual();                // TODO: f, Eq. (3)
  void evaluate_tangent();                 // TODO: T, Eq. (5)
  bool factorize();                        // TODO: T; false: it was refused, or has a NaN
  void solve(std::vector<double>& right);  // TODO: T^-1 right in its place, with the last factors
  void correct(const std::vector<double>& delta);  // TODO: q', v', a' of the new q', Eq. (2)
  void project();                                  // TODO: v', then a': step 3, for Eq. (6)

  const Model& model_;
  StepSettings settings_;
  State state_;  // from predict() on, q', v', a'

  // Row by row: entry (i, j) of a matrix with n columns is at i * n + j. Store them as you like.@STORAGE@
  std::vector<double> Phi_;    // m
  std::vector<double> Phi_q_;  // m x n
  std::vector<double> f_;      // n
  std::vector<double> T_;      // n x n; the ladder looks at its lower half
};

}  // namespace mbs::@NAME@
