// Simplicial LDL^T on the matrix in elimination order.
#include "solver.hpp"

namespace mbs::eigen_sparse {

template <class Scalar>
SimplicialSolver<Scalar>::SimplicialSolver(const Values& matrix, Definiteness definiteness, Tuning)
    : matrix_(matrix), definiteness_(definiteness) {
  factors_.analyzePattern(matrix_);
}

template <class Scalar>
bool SimplicialSolver<Scalar>::factorize() {
  factors_.refactorize(matrix_);
  // Eigen itself refuses nothing but a pivot that is exactly zero.
  if (factors_.info() != Eigen::Success) return false;
  const Side& pivots = factors_.pivots();
  return definiteness_ == Definiteness::positive
             ? pivots.template minCoeff<Eigen::PropagateNaN>() > 0
             : pivots.cwiseAbs().template minCoeff<Eigen::PropagateNaN>() > 0;
}

template <class Scalar>
void SimplicialSolver<Scalar>::solve(Side& x) const {
  factors_.matrixL().solveInPlace(x);
  x.array() /= factors_.pivots().array();
  factors_.matrixU().solveInPlace(x);
}

template class SimplicialSolver<double>;
template class SimplicialSolver<float>;

}  // namespace mbs::eigen_sparse
