// Positions of one half of a symmetric matrix, by compressed sparse columns.
#pragma once

#include <vector>

namespace mbs::csc_cholmod {

/// Which half of a symmetric matrix its columns hold; the diagonal belongs to both.
enum class Half {
  lower,  ///< rows >= column: what CHOLMOD's supernodal factorization reads in place
  upper,  ///< rows <= column: what its simplicial factorization reads in place
};

/// Position of a symmetric matrix; (row, column) and (column, row) are the same.
struct Position {
  int row = 0;
  int column = 0;
};

/// Immutable pattern of one half, n x n, rows ascending in each column.
///
/// Example, the upper half of [1 2 0; 2 3 4; 0 4 5]: column_start = {0, 1, 3, 5},
/// row = {0, 0, 1, 1, 2}; values that belong to it are {1, 2, 3, 4, 5}.
class HalfPattern {
 public:
  /// `positions` may come in any order and repeat.
  HalfPattern(Half half, int n, const std::vector<Position>& positions);

  /// The same matrix with unknown i called `number[i]`, as the half `half`.
  [[nodiscard]] HalfPattern renumbered(Half half, const std::vector<int>& number) const;

  [[nodiscard]] Half half() const { return half_; }
  [[nodiscard]] int size() const { return static_cast<int>(column_start_.size()) - 1; }
  [[nodiscard]] int nonzeros() const { return column_start_.back(); }
  [[nodiscard]] const std::vector<int>& column_start() const { return column_start_; }
  [[nodiscard]] const std::vector<int>& row() const { return row_; }

  /// All of them, each once.
  [[nodiscard]] std::vector<Position> positions() const;

  /// Index of an existing position in the arrays of values. A search: for set-up only.
  [[nodiscard]] int index(Position position) const;

 private:
  Half half_;
  std::vector<int> column_start_;  ///< n + 1
  std::vector<int> row_;           ///< nonzeros()
};

}  // namespace mbs::csc_cholmod
