// The linear system of the saddle-point form: Eqs. (12) and (13).
#pragma once

#include <vector>

#include "assembly.hpp"
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
  void solve(const double* rhs, double* solution) { solver_.solve(rhs, solution); }
  /// lambda += (4 / Delta t^2) mu, with mu of the solution.
  void update_multipliers(const double* Phi, const double* solution, double* lambda) const;

  /// The right-hand side of Eq. (13) solved for v' - v* or a' - a*.
  void project(const double* rates, double* rhs) const;

 private:
  const Jacobian<D>& jacobian_;
  const Forces<D>& forces_;
  const int n_;
  const int m_;
  const double quarter_;  ///< Delta t^2 / 4, s^2
  SaddlePointMatrix<D> matrix_;
  Solver solver_;
  std::vector<double> row_factors_;  ///< m, what multiplies the rows of Phi_q
};

}  // namespace mbs::csc_umfpack
