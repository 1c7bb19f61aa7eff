// The linear system of the penalty form: Eqs. (1) and (3) to (6) as far as alpha is in them.
#pragma once

#include <vector>

#include "assembly.hpp"
#include "forces.hpp"
#include "jacobian.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_umfpack {

/// T and its factors, and what the constraints put into right-hand sides. What it is made from must
/// outlive it; `jacobian` and `forces` are read as they are at each call.
template <int D>
class PenaltySystem {
 public:
  PenaltySystem(const MassMatrix& mass, const Jacobian<D>& jacobian, const Forces<D>& forces,
                const StepSettings& settings, Tuning tuning);

  /// Length of right-hand sides; the first n numbers are those of the coordinates.
  [[nodiscard]] int size() const { return tangent_.pattern().variables(); }

  /// Completes the right-hand side of Eq. (4), which has what is free of constraints.
  void add_constraints(const double* lambda, const double* Phi, double* rhs);
  void assemble() { tangent_.update(jacobian_, forces_); }
  [[nodiscard]] bool factorize() { return solver_.factorize(tangent_.values()); }
  /// The solution has the length of right-hand sides; it too starts with the coordinates.
  void solve(const double* rhs, double* solution) { solver_.solve(rhs, solution); }
  /// Eq. (1), with Phi of the new q'.
  void update_multipliers(const double* Phi, const double* solution, double* lambda) const;

  /// The right-hand side of Eq. (6) solved for v' - v* or a' - a*; `rates` (m) are Phi_q v* +
  /// Phi_t, or what stands there for a*. Phi_q is that in T, still in the Jacobian.
  void project(const double* rates, double* rhs);

 private:
  const Jacobian<D>& jacobian_;
  const Forces<D>& forces_;
  const double penalty_;  ///< alpha
  const double quarter_;  ///< Delta t^2 / 4, s^2
  const double factor_;   ///< (Delta t^2 / 4) alpha, kg / m^2
  Tangent<D> tangent_;
  Solver solver_;
  std::vector<double> row_factors_;  ///< m, what multiplies the rows of Phi_q
};

}  // namespace mbs::csc_umfpack
