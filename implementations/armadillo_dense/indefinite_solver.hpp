// Dense factorization of a symmetric indefinite matrix, in place, by LAPACK.
#pragma once

#include <armadillo>
#include <vector>

namespace mbs::armadillo_dense {

/// Factorizes A = P L D Lᵀ Pᵀ over the memory of A by the pivoting of Bunch and Kaufman, D with
/// blocks of 1 x 1 and 2 x 2, and solves with it. Only the lower triangle is used.
///
///   ... fill solver.matrix() ...
///   if (!solver.factorize()) ...
///   solver.solve(b);                     // b <- A⁻¹ b
class IndefiniteSolver {
 public:
  /// Storage for a matrix of this size, with LAPACK's workspace.
  explicit IndefiniteSolver(int size);

  /// A, to be filled before factorize(), which overwrites its lower triangle with L and D.
  [[nodiscard]] arma::mat& matrix() { return A_; }

  /// False if A is singular or holds a number that is not finite.
  [[nodiscard]] bool factorize();

  /// Overwrites b by A⁻¹ b with the last factorization.
  void solve(arma::vec& b) const;

 private:
  arma::mat A_;
  std::vector<arma::blas_int> pivots_;
  arma::vec workspace_;
};

}  // namespace mbs::armadillo_dense
