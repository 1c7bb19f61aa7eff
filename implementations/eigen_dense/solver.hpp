// Dense Cholesky factorization of the tangent matrix, in place.
#pragma once

#include <Eigen/Core>

namespace mbs::eigen_dense {

/// Up to here Eigen's unblocked kernel is the faster one; Eigen itself goes over to blocks at 32.
inline constexpr Eigen::Index kUnblockedLimit = 128;

/// Owns the tangent matrix T (n×n). Only its lower triangle is read; factorize() overwrites that
/// with L, T = L Lᵀ, so that T has to be written anew before every factorization.
template <typename Scalar>
class Solver {
 public:
  using Vector = Eigen::VectorX<Scalar>;
  using Matrix = Eigen::MatrixX<Scalar>;

  /// `unblocked`: up to how many variables the unblocked kernel is taken.
  explicit Solver(Eigen::Index variables, Eigen::Index unblocked = kUnblockedLimit)
      : matrix_(variables, variables), is_blocked_(variables > unblocked) {
    matrix_.setZero();
  }

  /// Where to write T (n×n, kg); L after factorize().
  Matrix& matrix() { return matrix_; }
  [[nodiscard]] const Matrix& matrix() const { return matrix_; }

  /// False if T is not numerically positive definite or not finite; solve() is then meaningless.
  [[nodiscard]] bool factorize();

  /// x (n) holds the right-hand side on entry and T⁻¹ times it on return.
  void solve(Vector& x) const;

 private:
  Matrix matrix_;
  bool is_blocked_;
};

}  // namespace mbs::eigen_dense
