// The linear system of the penalty form: T, its factor and the right-hand sides.
#pragma once

#include <armadillo>

#include "assembly.hpp"
#include "solver.hpp"

namespace mbs::armadillo_dense {

/// Eqs. (4) to (6). A right-hand side is made in place of the last solution, and solved in place.
///
///   system.evaluate(x);
///   system.residual(x, v, a, lambda);   // and assemble(), factorize()
///   system.solve();
///   ... system.solution() ...           // Δq
class PenaltySystem : public Assembly {
 public:
  PenaltySystem(const Model& model, const StepSettings& settings);

  /// Right-hand side of Eq. (4), with a (n) = a' and lambda (m).
  void residual(const arma::vec& x, const arma::vec& v, const arma::vec& a,
                const arma::vec& lambda);
  /// T by Eq. (5), with Phi_q of the last evaluate() and the forces of the last residual().
  void assemble();
  /// False if T is not positive definite or holds a number that is not finite.
  [[nodiscard]] bool factorize() { return solver_.factorize(); }
  void solve() { solver_.solve(rhs_); }
  /// n: Δq, v' - v* or a' - a*.
  [[nodiscard]] const arma::vec& solution() const { return rhs_; }
  /// lambda (m) after a pass, with Phi of the last evaluate().
  void update(arma::vec& lambda) const { lambda += alpha_ * constraints_.phi(); }  // Eq. (1)

  /// Products of v*, a* (n) with J, the Phi_q of the matrix: to be taken before the evaluate() at
  /// the final q'.
  void begin_velocity_projection(const arma::vec& v);
  void begin_acceleration_projection(const arma::vec& a);
  /// Right-hand sides of Eq. (6) for v' - v* and a' - a*, with v'.
  void velocity_projection(const arma::vec& x);
  void acceleration_projection(const arma::vec& x, const arma::vec& v);

 private:
  void add_linear_constraints(const Model& model);
  /// out (n) = -h α Jᵀ J x, with Phi_q of the last evaluate() for J.
  void penalty_product(const arma::vec& x, arma::vec& out);
  /// rhs_ -= h α Φqᵀ time_terms_.
  void subtract_time_terms();

  double alpha_;  ///< penalty factor
  CholeskySolver solver_;
  arma::mat constant_;  ///< n x n, lower triangle of M + h α Φqᵀ Φq of linear constraints; empty
                        ///< without them
  arma::vec mu_;          ///< m, lambda + alpha Phi, then J v*, J a*
  arma::vec rhs_;         ///< n, right-hand side, then solution
  arma::vec share_of_a_;  ///< n, -h α Jᵀ J a*
  arma::vec time_terms_;  ///< of the rows that can be nonzero: Φt, then Φ̇q v' + Φ̇t
};

}  // namespace mbs::armadillo_dense
