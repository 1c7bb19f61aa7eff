// Simplicial LDL^T on the matrix in elimination order.
#include "solver.hpp"

namespace mbs::eigen_sparse {

template <class Scalar, Tuning kTuning>
TunedSimplicial<Scalar, kTuning>::TunedSimplicial(const Values& matrix, Definiteness definiteness)
    : matrix_(matrix), definiteness_(definiteness) {
  factors_.analyzePattern(matrix_);
}

template <class Scalar, Tuning kTuning>
bool TunedSimplicial<Scalar, kTuning>::factorize() {
  factors_.refactorize(matrix_);
  // Eigen itself refuses nothing but a pivot that is exactly zero.
  if (factors_.info() != Eigen::Success) return false;
  const Side& pivots = factors_.pivots();
  return definiteness_ == Definiteness::positive
             ? pivots.template minCoeff<Eigen::PropagateNaN>() > 0
             : pivots.cwiseAbs().template minCoeff<Eigen::PropagateNaN>() > 0;
}

template <class Scalar, Tuning kTuning>
void TunedSimplicial<Scalar, kTuning>::solve(Side& x) const {
  factors_.matrixL().solveInPlace(x);
  x.array() /= factors_.pivots().array();
  factors_.matrixU().solveInPlace(x);
}

template class TunedSimplicial<double, Tuning::own>;
template class TunedSimplicial<double, Tuning::amd>;
template class TunedSimplicial<float, Tuning::own>;

}  // namespace mbs::eigen_sparse
