// Dense LU factorization of a symmetric matrix that need not be definite, in place.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace mbs::eigen_dense {

/// What Solver does, for any regular matrix, by rows interchanged: Eigen's LDLT, which keeps the
/// symmetry, has pivots 1×1 alone and is not stable without definiteness. Not to be copied or
/// moved, as its parts refer to each other.
template <typename Scalar>
class LuSolver {
 public:
  using Vector = Eigen::VectorX<Scalar>;
  using Matrix = Eigen::MatrixX<Scalar>;

  explicit LuSolver(Eigen::Index size);
  LuSolver(const LuSolver&) = delete;
  LuSolver& operator=(const LuSolver&) = delete;

  /// Where to write the lower triangle before every factorize(), which overwrites all.
  Matrix& matrix() { return matrix_; }

  /// False if the matrix is numerically singular or not finite; solve() is then meaningless.
  [[nodiscard]] bool factorize();

  /// x holds the right-hand side on entry and the solution on return.
  void solve(Vector& x);

 private:
  Matrix matrix_;
  Eigen::PartialPivLU<Eigen::Ref<Matrix>> lu_;  ///< works in matrix_
  Vector solution_;
};

}  // namespace mbs::eigen_dense
