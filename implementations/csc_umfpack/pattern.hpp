// Where the entries of M, T and the saddle-point matrix are.
#pragma once

#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::csc_umfpack {

/// Where the entries of a square matrix are, by compressed columns. Of a symmetric matrix both
/// triangles are kept, so that columns are rows too.
///
/// Example: [x . x; . x .; x . x] has starts = {0, 2, 3, 5} and rows = {0, 2, 1, 0, 2}.
struct SparsityPattern {
  std::vector<int> starts;  ///< n + 1
  std::vector<int> rows;    ///< ascending within each column

  [[nodiscard]] int variables() const { return static_cast<int>(starts.size()) - 1; }
  /// Index of entry (row, col), which must be there; for set-up only.
  [[nodiscard]] int position(int row, int col) const;
};

/// Lists of integers, one after the other: list r is items[starts[r]] ... items[starts[r + 1] - 1].
struct Lists {
  std::vector<int> starts{0};
  std::vector<int> items;

  [[nodiscard]] int count() const { return static_cast<int>(starts.size()) - 1; }
  [[nodiscard]] std::span<const int> operator[](int r) const {
    return std::span(items).subspan(starts[r], starts[r + 1] - starts[r]);
  }
  void end_list() { starts.push_back(static_cast<int>(items.size())); }
};

/// The pattern of M.
SparsityPattern mass_pattern(const Model& model);

/// The pattern of M and of all pairs of numbers that are in one of the lists.
SparsityPattern union_pattern(const SparsityPattern& mass, const Lists& coupled);

/// The pattern of [A J^T; J D] with diagonal D. `rows` are those of J, numbers in each ascending.
SparsityPattern bordered_pattern(const SparsityPattern& A, const Lists& rows);

/// For every number below `n`, the lists that it is in.
Lists transpose(const Lists& lists, int n);

}  // namespace mbs::csc_umfpack
