// Dense Cholesky factorization of the tangent matrix, in place.
#pragma once

#include <Eigen/Core>

namespace mbs::eigen_dense {

/// Owns the tangent matrix T (n×n). Only its lower triangle is read; factorize() overwrites that
/// with L, T = L Lᵀ, so that T has to be written anew before every factorization.
template <typename Scalar>
class Solver {
 public:
  using Vector = Eigen::VectorX<Scalar>;
  using Matrix = Eigen::MatrixX<Scalar>;

  explicit Solver(Eigen::Index variables) : matrix_(variables, variables) { matrix_.setZero(); }

  /// Where to write T (n×n, kg); L after factorize().
  Matrix& matrix() { return matrix_; }
  [[nodiscard]] const Matrix& matrix() const { return matrix_; }

  /// False if T is not numerically positive definite or not finite; solve() is then meaningless.
  [[nodiscard]] bool factorize();

  /// x (n) holds the right-hand side on entry and T⁻¹ times it on return.
  void solve(Vector& x) const;

 private:
  Matrix matrix_;
};

}  // namespace mbs::eigen_dense
