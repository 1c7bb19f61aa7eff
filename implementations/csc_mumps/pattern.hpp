// Sparse patterns: compressed columns for the loops here, entry by entry for MUMPS.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace mbs::csc_mumps {

/// Compressed sparse columns: column j holds the rows row[start[j]] < ... < row[start[j + 1] - 1].
/// That of a symmetric matrix is its lower triangle, diagonal included: the first of them is j.
///
/// Example: [4 1; 1 8] has start 0 2 3, row 0 1 1, and the values 4 1 8.
struct ColumnPattern {
  std::vector<int> start;  ///< one more than columns
  std::vector<int> row;    ///< one an entry

  [[nodiscard]] int columns() const { return static_cast<int>(start.size()) - 1; }
  /// Where the stored entry (i, j) is in an array of values.
  [[nodiscard]] int entry(int i, int j) const {
    const auto first = row.begin();
    return static_cast<int>(std::lower_bound(first + start[j], first + start[j + 1], i) - first);
  }
};

/// The pattern of `entries` = (column, row), which may be repeated.
ColumnPattern pattern_of(int columns, std::vector<std::pair<int, int>> entries);

/// An entry of a row: its column, and its place in the array of values by columns.
struct RowEntry {
  int column, place;
};
/// The rows of `pattern`, each by ascending columns.
std::vector<std::vector<RowEntry>> rows_of(const ColumnPattern& pattern, int rows);

/// Entries of one triangle of a symmetric matrix, in any order, indices from 1: what MUMPS takes.
struct Triplets {
  int order = 0;
  std::vector<int> row, column;

  void add(int i, int j) {
    row.push_back(i + 1);
    column.push_back(j + 1);
  }
  /// Adds the entries of `pattern`, `below` rows further down.
  void add(const ColumnPattern& pattern, int below = 0) {
    for (int j = 0; j < pattern.columns(); ++j) {
      for (int k = pattern.start[j]; k < pattern.start[j + 1]; ++k) add(pattern.row[k] + below, j);
    }
  }
};

}  // namespace mbs::csc_mumps
