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
  PenaltySystem(const Model& model, const StepSettings& settings,
                CholeskySolver::Solves solves = CholeskySolver::Solves::trsv);

  /// Right-hand side of Eq. (4), with lambda (m).
  void residual(const arma::vec& x, const arma::vec& v, const arma::vec& a,
                const arma::vec& lambda);
  /// T by Eq. (5), with Phi_q of the last evaluate() and the forces of the last residual().
  void assemble();
  /// False if T is not positive definite or holds a number that is not finite.
  [[nodiscard]] bool factorize() { return solver_.factorize(); }
  void solve() { solver_.solve(rhs_); }
  /// n: Δq, v' - v* or a' - a*.
  [[nodiscard]] const arma::vec& solution() const { return rhs_; }
  /// What update() needs after the last pass; Phi_q stays.
  void evaluate_last(const arma::vec& x) { constraints_.evaluate_phi(x); }
  /// lambda (m) after a pass, with Phi of the last evaluate() or evaluate_last().
  void update(arma::vec& lambda) const { lambda += alpha_ * constraints_.phi(); }  // Eq. (1)

  /// Right-hand sides of Eq. (6) for v' - v* from v*, and for a' - a* from v' and a*. Phi_q of the
  /// last evaluate() has to be that of the matrix.
  void velocity_projection(const arma::vec& v);
  void acceleration_projection(const arma::vec& v, const arma::vec& a);

 private:
  void add_linear_constraints(const Model& model);
  /// rhs_ = -h α Φqᵀ mu_.
  void penalty_product();

  double alpha_;  ///< penalty factor
  CholeskySolver solver_;
  arma::mat constant_;  ///< n x n, lower triangle of M + h α Φqᵀ Φq of linear constraints; empty
                        ///< without them
  arma::vec mu_;   ///< m, lambda + alpha Phi; then the first, then the second derivative of Phi
  arma::vec rhs_;  ///< n, right-hand side, then solution
};

/// The same with dpotrs.
class PotrsSystem : public PenaltySystem {
 public:
  PotrsSystem(const Model& model, const StepSettings& settings)
      : PenaltySystem(model, settings, CholeskySolver::Solves::potrs) {}
};

}  // namespace mbs::armadillo_dense
