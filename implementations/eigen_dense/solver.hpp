// Dense Cholesky factorization of the tangent matrix, in place.
#pragma once

#include <Eigen/Core>

namespace mbs::eigen_dense {

/// Owns the tangent matrix T (n×n). Only its lower triangle is read; factorize() overwrites that
/// with L, T = L Lᵀ, so that T has to be written anew before every factorization.
class Solver {
 public:
  explicit Solver(Eigen::Index variables) : matrix_(variables, variables) { matrix_.setZero(); }

  /// Where to write T (n×n, kg).
  Eigen::MatrixXd& matrix() { return matrix_; }

  /// False if T is not numerically positive definite or not finite; solve() is then meaningless.
  [[nodiscard]] bool factorize();

  /// x (n) holds the right-hand side on entry and T⁻¹ times it on return.
  void solve(Eigen::VectorXd& x) const;

 private:
  Eigen::MatrixXd matrix_;
};

}  // namespace mbs::eigen_dense
