// One simulation in D dimensions: the step of paper/README.md on the storage of assembly.hpp.
#pragma once

#include <cstddef>
#include <vector>

#include "assembly.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "jacobian.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_umfpack {

template <int D>
class CscUmfpack final : public Simulation {
 public:
  CscUmfpack(const Model& model, const StepSettings& settings);

 private:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  /// Step 0: positions and velocities of driven points, driven values, Q of driven masses.
  void drive();
  /// Step 1: q, v, a at the end of the step; Phi and Phi_q there.
  void predict();
  /// rhs = -f, Eq. (3), from q, v, a, lambda, Phi and Phi_q; the elements' values for T.
  void evaluate_residual();
  /// Adds Delta q to the motion. True if all |Delta q| are within the tolerance, no NaN among them.
  [[nodiscard]] bool correct();
  /// Phi and Phi_q at the new q, and lambda by Eq. (1).
  void update_multipliers();
  /// Step 3, Eq. (6): the first Count of the projections.
  template <std::size_t Count>
  void project();
  void project_velocity();
  void project_acceleration();

  const StepSettings settings_;
  const int n_;
  const int m_;
  const double quarter_;  ///< Delta t^2 / 4, s^2
  const double factor_;   ///< (Delta t^2 / 4) alpha, kg / m^2

  const PointLayout points_;
  MassMatrix mass_;
  Jacobian<D> jacobian_;
  Forces<D> forces_;
  Tangent<D> tangent_;
  Solver solver_;
  Drivers<D> drivers_;
  std::vector<double> force_;  ///< n, Q without elements: constant during a step

  std::vector<double> q_;            ///< n, then the fixed points: x of the layout
  std::vector<double> v_;            ///< n, then those of the fixed points
  std::vector<double> a_;            ///< n
  std::vector<double> lambda_;       ///< m, rows of the layout
  std::vector<double> Phi_;          ///< m, rows of the layout
  std::vector<double> row_factors_;  ///< m, what multiplies the rows of Phi_q
  std::vector<double> rhs_;          ///< n
  std::vector<double> rhs_a_;        ///< n, right-hand side for a' in Eq. (6)
  std::vector<double> delta_q_;      ///< n
};

}  // namespace mbs::csc_umfpack
