// Cholesky factorization of a symmetric positive definite matrix in envelope (skyline) storage.
#pragma once

#include <cstddef>
#include <vector>

namespace mbs {

/// Row i of the lower triangle holds the columns first[i] ... i. Elimination makes no entries
/// outside this envelope, which is why the storage is so simple.
///
/// Example: rows [4], [2 5], [. 1 3] with first = {0, 0, 1} are stored as 4 | 2 5 | 1 3.
class EnvelopeCholesky {
 public:
  using Real = long double;

  /// `first[i]` <= i is the first column of row i.
  explicit EnvelopeCholesky(std::vector<int> first);

  void set_zero();
  /// Entry (row, col) with first[row] <= col <= row.
  Real& at(int row, int col) { return values_[start_[row] + static_cast<std::size_t>(col)]; }

  /// Replaces the matrix by its factor L with A = L L^T; false if A is not positive definite.
  [[nodiscard]] bool factorize();
  /// Overwrites b by the solution of L L^T x = b.
  void solve(std::vector<Real>& b) const;

 private:
  [[nodiscard]] Real entry(int row, int col) const {
    return values_[start_[row] + static_cast<std::size_t>(col)];
  }

  int n_;
  std::vector<int> first_;
  std::vector<std::size_t> start_;  // start_[i] + col is the place of (i, col); modulo 2^64
  std::vector<Real> values_;
};

}  // namespace mbs
