// LAPACK's general linear solver, DGESV, taken apart into factorization and solution.
#pragma once

#include <string>
#include <vector>

#include "matrix.hpp"

namespace mbs::starting_dense {

/// LU factorization with partial pivoting of one tangent matrix after another.
///
///   assembly.tangent(factor, solver.matrix());  // the matrix goes in where the factors will be
///   if (!solver.factorize()) return failure;
///   solver.solve(x);                            // as often as needed, with the kept factors
class Solver {
 public:
  explicit Solver(int variables) : matrix_(variables, variables), pivots_(variables) {}

  /// Storage (n x n) of the matrix to factorize; factorize() overwrites it by L and U.
  Matrix& matrix() { return matrix_; }

  /// False if the matrix is not finite or exactly singular. Relies on the matrix being positive
  /// semidefinite but for rounding, so that its diagonal tells whether it is finite.
  [[nodiscard]] bool factorize();

  /// x (n): the right-hand side goes in, the solution comes out.
  void solve(Vector& x) const;

  /// Version of the LAPACK in use, as it reports it itself.
  static std::string version();

 private:
  Matrix matrix_;
  std::vector<int> pivots_;
};

}  // namespace mbs::starting_dense
