// The step of paper/README.md on dense matrices.
#pragma once

#include "assembly.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::starting_dense {

/// q_ and v_ are extended by points that are not free (see Layout); a_ has n entries, lambda_ m.
class DenseSimulation final : public Simulation {
 public:
  DenseSimulation(const Model& model, const StepSettings& settings);

 private:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  void predict();
  /// Solves Eq. (4) and updates q', v' and a'. `converged` tells whether max |Delta q| <=
  /// tolerance. False if the factorization failed.
  [[nodiscard]] bool pass(bool& converged);
  void apply_increment(bool& converged);
  /// Evaluates Phi and Phi_q at the new q' and updates lambda.
  void update_multipliers();
  /// Eq. (6), solved for v' - v* and a' - a*; Phi_q is still the one in the tangent.
  void project();

  const StepSettings settings_;
  const int n_;
  Assembly assembly_;
  Solver solver_;

  Vector q_, v_, a_, lambda_;
  Vector multipliers_;  ///< lambda + alpha Phi, m
  Vector solution_;     ///< n; right-hand side, then solution of Eq. (4) or (6)
};

}  // namespace mbs::starting_dense
