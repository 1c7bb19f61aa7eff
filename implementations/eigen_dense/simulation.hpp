// One simulation: the state and the step of paper/README.md, over Assembly and Solver.
#pragma once

#include <Eigen/Core>

#include "assembly.hpp"
#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::eigen_dense {

/// Holds q and v as extended vectors (see Layout), so that fixed points cost nothing in a step.
class Simulation final : public mbs::Simulation {
 public:
  Simulation(const Model& model, const StepSettings& settings);

 private:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  void predict();
  /// One Newton pass, with the multiplier update. Leaves the phase at `other`. False if the
  /// factorization failed; `converged` says whether max|Δq| is within the tolerance.
  [[nodiscard]] bool pass(bool& converged);
  /// Adds the solution Δq to q' and its multiples to v' and a'; whether max|Δq| ≤ tolerance.
  [[nodiscard]] bool update();
  void project();

  StepSettings settings_;
  Layout layout_;
  Assembly assembly_;
  Solver solver_;

  Eigen::VectorXd q_, v_;     ///< extended; m, m/s
  Eigen::VectorXd a_;         ///< n, m/s²
  Eigen::VectorXd lambda_;    ///< m
  Eigen::VectorXd solution_;  ///< n; right-hand side, then solution of a linear system
};

}  // namespace mbs::eigen_dense
