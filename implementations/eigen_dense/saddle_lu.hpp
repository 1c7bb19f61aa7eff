// Dense LU factorization with partial pivoting of the saddle-point matrix of Eq. (12), in float.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace mbs::eigen_dense {

/// What SaddleSolver does, by rows interchanged: it keeps in float what the squares in S lose near
/// singular positions. Not to be copied or moved, as its parts refer to each other.
class SaddleLu {
 public:
  using Scalar = float;
  using Vector = Eigen::VectorXf;
  using Matrix = Eigen::MatrixXf;

  SaddleLu(Eigen::Index variables, Eigen::Index constraints, float epsilon);
  SaddleLu(const SaddleLu&) = delete;
  SaddleLu& operator=(const SaddleLu&) = delete;

  /// Where to write T₀ (n×n, kg; lower triangle read).
  Matrix& leading() { return leading_; }
  /// Where to write Φqᵀ (n×m) before every factorize().
  auto coupling() { return matrix_.topRightCorner(leading_.rows(), constraints_); }

  /// There is nothing to be done for T₀ alone.
  void factorize_leading() {}

  /// False if the matrix is numerically singular or not finite; solve() is then meaningless.
  [[nodiscard]] bool factorize();

  /// x (n + m) holds the right-hand side on entry and the solution on return.
  void solve(Vector& x);

 private:
  Eigen::Index constraints_;
  float epsilon_;
  Matrix leading_;                              ///< T₀
  Matrix matrix_;                               ///< the whole, then its factors
  Eigen::PartialPivLU<Eigen::Ref<Matrix>> lu_;  ///< works in matrix_
  Vector solution_;
};

}  // namespace mbs::eigen_dense
