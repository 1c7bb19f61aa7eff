// Simplicial LDL^T on the matrix in elimination order.
#include "solver.hpp"

#include <Eigen/OrderingMethods>

namespace mbs::eigen_superlu {

std::vector<int> SimplicialSolver::elimination_order(const SparseMatrix& pattern) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  std::vector<int> position(pattern.cols());
  for (int k = 0; k < pattern.cols(); ++k) position[order.indices()[k]] = k;
  return position;
}

SimplicialSolver::SimplicialSolver(const SparseMatrix& tangent) : tangent_(tangent) {
  factors_.analyzePattern(tangent_);
}

bool SimplicialSolver::factorize() {
  factors_.refactorize(tangent_);
  // Eigen itself refuses nothing but a pivot that is exactly zero.
  return factors_.info() == Eigen::Success &&
         factors_.pivots().minCoeff<Eigen::PropagateNaN>() > 0.0;
}

void SimplicialSolver::solve(Vector& x) const {
  factors_.matrixL().solveInPlace(x);
  x.array() /= factors_.pivots().array();
  factors_.matrixU().solveInPlace(x);
}

}  // namespace mbs::eigen_superlu
