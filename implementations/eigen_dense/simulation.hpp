// The simulation with default settings: the step of paper/README.md and no choices.
#pragma once

#include <Eigen/Core>

#include "assembly.hpp"
#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "motion.hpp"
#include "solver.hpp"

namespace mbs::eigen_dense {

/// Penalty form, multipliers and tangent new in every pass, every step projected.
class Simulation final : public mbs::Simulation {
 public:
  /// `unblocked`: as Solver's.
  Simulation(const Model& model, const StepSettings& settings,
             Eigen::Index unblocked = kUnblockedLimit);

 private:
  void do_set_state(const State& state) override { motion_.set(state); }
  StepOutcome do_step() override;
  void do_get_state(State& state) const override { motion_.get(state); }

  /// One Newton pass, with the multiplier update, counted; the last one with the projections.
  /// Leaves the phase at `other`. The status becomes `converged` if max|Δq| is within the
  /// tolerance.
  void pass(StepOutcome& outcome);
  /// Eq. (6), before the evaluation at the final q'.
  void project();
  /// Solves Eq. (6) for a change, with Φq v* + Φt or Φq a* + Φ̇q v' + Φ̇t for `error` (m).
  void solve_projection(const Eigen::VectorXd& error);

  StepSettings settings_;
  Layout layout_;
  Assembly<double> assembly_;
  Solver<double> solver_;
  Motion<double> motion_;
  Eigen::VectorXd solution_;  ///< n; right-hand side, then solution of a linear system
};

}  // namespace mbs::eigen_dense
