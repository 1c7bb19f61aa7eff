// L D L^T factorization without pivoting of a symmetric matrix in envelope (skyline) storage.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace mbs {

/// Row i of the lower triangle holds the columns first[i] ... i. Elimination makes no entries
/// outside this envelope, which is why the storage is so simple. For positive definite and for
/// quasi-definite matrices, which have such factors in every order.
///
/// Example: rows [4], [2 5], [. 1 3] with first = {0, 0, 1} are stored as 4 | 2 5 | 1 3.
class EnvelopeLdlt {
 public:
  using Real = long double;

  /// `first[i]` <= i is the first column of row i.
  explicit EnvelopeLdlt(std::vector<int> first);

  void set_zero();
  /// Entry (row, col) with first[row] <= col <= row.
  Real& at(int row, int col) { return values_[start_[row] + static_cast<std::size_t>(col)]; }
  /// The same for any 0 <= col <= row; zero outside the envelope.
  [[nodiscard]] Real value(int row, int col) const {
    return col < first_[row] ? Real{0} : entry(row, col);
  }

  /// Replaces the matrix by its factors L and D; false unless D has exactly `negative` negative
  /// entries, or any number without one, and is otherwise positive.
  [[nodiscard]] bool factorize(std::optional<int> negative);
  /// Overwrites b by the solution of L D L^T x = b.
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
