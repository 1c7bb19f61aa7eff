// Dense Cholesky factorization of the tangent matrix, in place, by LAPACK and BLAS.
#pragma once

#include <armadillo>

namespace mbs::armadillo_dense {

/// Factorizes T = L Lᵀ over the memory of T and solves with L. Only the lower triangle is used.
///
///   assembly.tangent(solver.matrix());
///   if (!solver.factorize()) ...
///   solver.solve(b);                     // b <- T⁻¹ b
class CholeskySolver {
 public:
  /// How L is solved with: dtrsv twice, or dpotrs, which takes many right-hand sides.
  enum class Solves { trsv, potrs };

  /// Storage for an n x n matrix.
  CholeskySolver(int n, Solves solves) : T_(n, n, arma::fill::zeros), solves_(solves) {}

  /// T (n x n), to be filled before factorize(), which overwrites its lower triangle with L.
  [[nodiscard]] arma::mat& matrix() { return T_; }

  /// False if T is not positive definite or holds a number that is not finite.
  [[nodiscard]] bool factorize();

  /// Overwrites b (n) by T⁻¹ b with the last factorization.
  void solve(arma::vec& b) const;

 private:
  arma::mat T_;
  Solves solves_;
};

}  // namespace mbs::armadillo_dense
