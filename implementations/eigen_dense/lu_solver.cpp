// Dense LU factorization of a symmetric matrix that need not be definite, in place.
#include "lu_solver.hpp"

#include <cmath>

namespace mbs::eigen_dense {

template <typename Scalar>
LuSolver<Scalar>::LuSolver(Eigen::Index size)
    : matrix_(Matrix::Identity(size, size)), lu_(matrix_), solution_(Vector::Zero(size)) {}

template <typename Scalar>
bool LuSolver<Scalar>::factorize() {
  matrix_.template triangularView<Eigen::StrictlyUpper>() = matrix_.transpose();
  lu_.compute(matrix_);
  const auto pivots = matrix_.diagonal();
  return std::isfinite(pivots.sum()) && (pivots.array() != Scalar(0)).all();
}

template <typename Scalar>
void LuSolver<Scalar>::solve(Vector& x) {
  solution_ = lu_.solve(x);
  x.swap(solution_);
}

template class LuSolver<double>;
template class LuSolver<float>;

}  // namespace mbs::eigen_dense
