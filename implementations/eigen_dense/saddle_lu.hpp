// Dense LU factorization of the saddle-point matrix of Eq. (12), put together.
#pragma once

#include <Eigen/Core>

#include "lu_solver.hpp"

namespace mbs::eigen_dense {

/// What SaddleSolver does, by rows interchanged: T₀ need not be definite, and float keeps what the
/// squares in S lose near singular positions.
template <typename Scalar>
class SaddleLu {
 public:
  using Vector = Eigen::VectorX<Scalar>;
  using Matrix = Eigen::MatrixX<Scalar>;

  SaddleLu(Eigen::Index variables, Eigen::Index constraints, Scalar epsilon);

  /// Where to write T₀ (n×n, kg; lower triangle read).
  Matrix& leading() { return leading_; }
  /// Where to write Φqᵀ (n×m) before every factorize().
  auto coupling() {
    return whole_.matrix().bottomLeftCorner(constraints_, leading_.rows()).transpose();
  }

  /// There is nothing to be done for T₀ alone.
  void factorize_leading() {}

  /// False if the matrix is numerically singular or not finite; solve() is then meaningless.
  [[nodiscard]] bool factorize();

  /// x (n + m) holds the right-hand side on entry and the solution on return.
  void solve(Vector& x) { whole_.solve(x); }

 private:
  Eigen::Index constraints_;
  Scalar epsilon_;
  Matrix leading_;  ///< T₀
  LuSolver<Scalar> whole_;
};

}  // namespace mbs::eigen_dense
