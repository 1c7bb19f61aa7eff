// The linear system of the saddle-point form: Eqs. (12) and (13).
#pragma once

#include <vector>

#include "assembly.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "jacobian.hpp"
#include "mbs/simulation.hpp"
#include "saddle_point_matrix.hpp"
#include "solver.hpp"

namespace mbs::csc_umfpack {

/// To be used like a PenaltySystem. Right-hand sides have n + m numbers.
template <int D>
class SaddlePointSystem {
 public:
  SaddlePointSystem(const MassMatrix& mass, const Jacobian<D>& jacobian, const Forces<D>& forces,
                    const StepSettings& settings, Tuning tuning);

  [[nodiscard]] int size() const { return matrix_.pattern().variables(); }

  /// Completes the right-hand side of Eq. (12), which has what is free of constraints.
  void add_constraints(const double* lambda, const double* Phi, double* rhs);
  void assemble() { matrix_.update(jacobian_, forces_); }
  [[nodiscard]] bool factorize() { return solver_.factorize(matrix_.values()); }
  /// x (n) = the solution for the coordinates; that for the multipliers is kept.
  void solve(const double* rhs, double* x);
  /// lambda += (4 / Delta t^2) mu, with mu of the last solution.
  void update_multipliers(const double* Phi, double* lambda) const;

  /// rhs = the share that Phi_q of the last pass, still in the Jacobian, has in the right-hand side
  /// of Eq. (13) solved for v' - v* or a' - a*; `moving` (n) is v* or a*.
  void start_projection(const double* moving, double* rhs) const;
  /// Complete these right-hand sides; q and v are those of the end of the step, laid out as x of
  /// the layout.
  void add_rates(const Drivers<D>& drivers, const double* q, double* rhs) const;
  void add_accelerations(const Drivers<D>& drivers, const double* q, const double* v,
                         double* rhs) const;

 private:
  const Jacobian<D>& jacobian_;
  const Forces<D>& forces_;
  const int n_;
  const int m_;
  const double quarter_;  ///< Delta t^2 / 4, s^2
  SaddlePointMatrix<D> matrix_;
  Solver solver_;
  std::vector<double> row_factors_;  ///< m, what multiplies the rows of Phi_q
  std::vector<double> solution_;     ///< n + m
};

}  // namespace mbs::csc_umfpack
