// Factorization of saddle-point matrices and solves by blocks.
#pragma once

#include "mechanism.hpp"
#include "saddle_matrix.hpp"
#include "solver.hpp"

namespace mbs::eigen_sparse {

/// Solves with the matrix of Eqs. (12) to (14) for a mechanism.
template <class Solver>
class SaddleSolver {
 public:
  SaddleSolver(const Model& model, double epsilon, const Mechanism& mechanism, Stiffness stiffness,
               Tuning tuning)
      : matrix_(model, mechanism.coordinates, mechanism.constraints, Solver::kTriangle, epsilon,
                stiffness, Solver::saddle_order, tuning),
        solver_(matrix_.matrix(), Definiteness::quasi, tuning),
        packed_(matrix_.matrix().cols()) {}

  /// The matrix, for those who refresh it.
  [[nodiscard]] SaddleMatrix& matrix() { return matrix_; }
  [[nodiscard]] bool factorize() { return solver_.factorize(); }

  /// Overwrites x (n) and y (m), the two blocks of a right-hand side, by those of the solution.
  void solve(Vector& x, Vector& y) {
    const auto unknowns = matrix_.unknowns(), multipliers = matrix_.multipliers();
    for (std::size_t i = 0; i < unknowns.size(); ++i) packed_[unknowns[i]] = x[i];
    for (std::size_t i = 0; i < multipliers.size(); ++i) packed_[multipliers[i]] = y[i];
    solver_.solve(packed_);
    for (std::size_t i = 0; i < unknowns.size(); ++i) x[i] = packed_[unknowns[i]];
    for (std::size_t i = 0; i < multipliers.size(); ++i) y[i] = packed_[multipliers[i]];
  }

 private:
  SaddleMatrix matrix_;
  Solver solver_;
  Vector packed_;  // n + m, in the order of the matrix
};

}  // namespace mbs::eigen_sparse
