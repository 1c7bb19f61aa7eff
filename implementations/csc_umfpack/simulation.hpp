// One simulation in D dimensions: the step of paper/README.md on the storage of assembly.hpp.
#pragma once

#include <vector>

#include "assembly.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "jacobian.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_umfpack {

/// `System` is PenaltySystem or SaddlePointSystem: the linear system of passes and projections.
template <int D, template <int> class System>
class CscUmfpack final : public Simulation {
 public:
  CscUmfpack(const Model& model, const StepSettings& settings, Tuning tuning);

 private:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  /// Step 0: driven points, driven values, Q of driven masses.
  void drive();
  /// Step 1: q, v, a at the end of the step; Phi and Phi_q there.
  void predict();
  /// The right-hand side of a pass from q, v, a, lambda, Phi and Phi_q; the elements' values.
  void evaluate_residual();
  /// Corrects v and a. True if all |Delta q| are within the tolerance, no NaN among them.
  [[nodiscard]] bool correct();
  /// Step 3: the projections, while q and Phi_q are still those of the last pass.
  void project();
  /// x (n) += what projects it, from its rates_.
  void add_projection(std::vector<double>& x);
  /// Phi and Phi_q at q.
  void evaluate_constraints();

  const StepSettings settings_;
  const int n_;
  const int m_;
  const double quarter_;  ///< Delta t^2 / 4, s^2

  const PointLayout points_;
  MassMatrix mass_;
  Jacobian<D> jacobian_;
  Forces<D> forces_;
  System<D> system_;
  Drivers<D> drivers_;
  std::vector<double> force_;  ///< n, Q without elements: constant during a step

  std::vector<double> q_;       ///< n, then the fixed points: x of the layout
  std::vector<double> v_;       ///< n, then those of the fixed points
  std::vector<double> a_;       ///< likewise
  std::vector<double> lambda_;  ///< m, rows of the layout
  std::vector<double> Phi_;     ///< m, rows of the layout
  std::vector<double> rates_;   ///< m, first or second derivative of Phi by time
  std::vector<double> rhs_;     ///< of the system
  std::vector<double> delta_;   ///< solution of the system: Delta q first
  std::vector<double> change_;  ///< likewise: v' - v* or a' - a* first
};

}  // namespace mbs::csc_umfpack
