// L L^T by MKL's PARDISO through Eigen::PardisoLLT, built only where CMake finds MKL.
#pragma once

#include <Eigen/PardisoSupport>
#include <cmath>
#include <numeric>
#include <vector>

#include "solver.hpp"

namespace mbs::eigen_sparse {

/// The same contract as SimplicialSolver, for positive definite matrices. PARDISO orders by itself
/// and keeps that order, so the unknowns stay in the model's. Eigen copies the matrix by rows in
/// every factorization, and the right-hand side of a solve in place.
class PardisoSolver {
 public:
  using Values = SparseMatrix;
  using Side = Vector;
  static constexpr Triangle kTriangle = Triangle::upper;
  [[nodiscard]] static std::vector<int> elimination_order(const SparseMatrix& pattern, Tuning) {
    std::vector<int> identity(pattern.cols());
    std::iota(identity.begin(), identity.end(), 0);
    return identity;
  }

  /// Symbolic analysis. `matrix` outlives the solver; its values may change, its pattern not.
  PardisoSolver(const Values& matrix, Definiteness, Tuning) : matrix_(matrix) {
    factors_.pardisoParameterArray()[7] = 0;  // no steps of refinement: nobody else does any
    factors_.analyzePattern(matrix_);
  }
  /// False if the matrix is not positive definite or not finite.
  [[nodiscard]] bool factorize() {
    if (!std::isfinite(matrix_.diagonal().sum())) return false;
    factors_.factorize(matrix_);
    return factors_.info() == Eigen::Success;
  }
  /// Overwrites x (n) by the solution.
  void solve(Side& x) { x = factors_.solve(x); }

 private:
  const Values& matrix_;
  Eigen::PardisoLLT<Values, Eigen::Upper> factors_;
};

}  // namespace mbs::eigen_sparse
