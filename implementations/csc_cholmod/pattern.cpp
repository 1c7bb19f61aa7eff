// Builds the pattern of one half in time linear in the positions, but for sorting each column.
#include "pattern.hpp"

#include <algorithm>

namespace mbs::csc_cholmod {
namespace {

Position in_half(Half half, Position p) {
  const bool swap = half == Half::lower ? p.row < p.column : p.row > p.column;
  return swap ? Position{p.column, p.row} : p;
}

}  // namespace

HalfPattern::HalfPattern(Half half, int n, const std::vector<Position>& positions)
    : half_(half), column_start_(n + 1), row_(positions.size()) {
  for (const Position& p : positions) ++column_start_[in_half(half, p).column + 1];
  for (int j = 0; j < n; ++j) column_start_[j + 1] += column_start_[j];
  std::vector<int> next(column_start_.begin(), column_start_.end() - 1);
  for (const Position& p : positions) {
    const Position here = in_half(half, p);
    row_[next[here.column]++] = here.row;
  }
  auto end = row_.begin();  // of what is kept: ascending rows, each once
  for (int j = 0; j < n; ++j) {
    const auto first = row_.begin() + column_start_[j];
    const auto last = row_.begin() + next[j];
    std::sort(first, last);
    const auto unique_last = std::unique(first, last);
    column_start_[j] = static_cast<int>(end - row_.begin());
    end = std::move(first, unique_last, end);
  }
  column_start_[n] = static_cast<int>(end - row_.begin());
  row_.erase(end, row_.end());
  row_.shrink_to_fit();
}

HalfPattern HalfPattern::renumbered(Half half, const std::vector<int>& number) const {
  std::vector<Position> result = positions();
  for (Position& p : result) p = {number[p.row], number[p.column]};
  return HalfPattern(half, size(), result);
}

std::vector<Position> HalfPattern::positions() const {
  std::vector<Position> result;
  result.reserve(row_.size());
  for (int j = 0; j < size(); ++j) {
    for (int p = column_start_[j]; p < column_start_[j + 1]; ++p) result.push_back({row_[p], j});
  }
  return result;
}

int HalfPattern::index(Position position) const {
  const Position p = in_half(half_, position);
  const auto first = row_.begin() + column_start_[p.column];
  const auto last = row_.begin() + column_start_[p.column + 1];
  return static_cast<int>(std::lower_bound(first, last, p.row) - row_.begin());
}

}  // namespace mbs::csc_cholmod
