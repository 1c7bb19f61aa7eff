// The linear system of the saddle-point form: its matrix, factors and right-hand sides.
#pragma once

#include <armadillo>

#include "assembly.hpp"
#include "indefinite_solver.hpp"

namespace mbs::armadillo_dense {

/// Eqs. (12) and (13), with the interface of PenaltySystem. Multipliers come before coordinates, so
/// that a column of Phi_qᵀ is one of the matrix.
class SaddlePointSystem : public Assembly {
 public:
  SaddlePointSystem(const Model& model, const StepSettings& settings);

  /// Right-hand side of Eq. (12), with lambda (m).
  void residual(const arma::vec& x, const arma::vec& v, const arma::vec& a,
                const arma::vec& lambda);
  /// The matrix of Eq. (12), with Phi_q of the last evaluate() and the forces of the last
  /// residual().
  void assemble();
  /// False if the matrix is singular or holds a number that is not finite.
  [[nodiscard]] bool factorize() { return solver_.factorize(); }
  void solve() { solver_.solve(rhs_); }
  /// n: Δq, v' - v* or a' - a*.
  [[nodiscard]] const arma::vec& solution() const { return coordinates_; }
  /// Nothing: update() does not need Phi.
  void evaluate_last(const arma::vec& /*x*/) {}
  /// lambda (m) after a pass, with the last solution.
  void update(arma::vec& lambda) const { lambda += 1.0 / h_ * multipliers_; }

  /// Right-hand sides of Eq. (13) for v' - v* from v*, and for a' - a* from v' and a*. Phi_q of the
  /// last evaluate() has to be that of the matrix.
  void velocity_projection(const arma::vec& v);
  void acceleration_projection(const arma::vec& v, const arma::vec& a);

 private:
  double epsilon_;
  IndefiniteSolver solver_;
  arma::vec rhs_;          ///< n + m, right-hand side, then solution
  arma::vec multipliers_;  ///< the first m of rhs_, in its memory
  arma::vec coordinates_;  ///< the other n
};

}  // namespace mbs::armadillo_dense
