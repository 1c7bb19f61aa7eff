// KLU on the tangent matrix: analysed once for all positions it can have, then refactorized.
#pragma once

#include <memory>

#include "matrices.hpp"

namespace mbs::ublas_sparse {

/// T x = b with T symmetric positive definite (n x n). AMD ordering; pivots stay on the diagonal,
/// which is stable for such T and lets every factorization after the first be a refactorization.
class KluSolver {
 public:
  /// Analyses `pattern`, from tangent_pattern(); its values are not used.
  /// Throws Unsupported if KLU cannot analyse it.
  explicit KluSolver(const SparseMatrix& pattern);
  ~KluSolver();

  /// Takes over the values of T, whose positions are among those of the pattern; completes the
  /// column pointers of T, which uBLAS leaves open after the last column that it filled.
  void load(SparseMatrix& T);
  /// Factorizes the loaded matrix. False if it is not positive definite or not finite.
  [[nodiscard]] bool factorize();
  /// Overwrites the right-hand side b (n) with x, by the last factorization.
  void solve(Vector& b);

 private:
  struct Klu;
  std::unique_ptr<Klu> klu_;
};

}  // namespace mbs::ublas_sparse
