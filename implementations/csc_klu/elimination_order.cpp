// In which order to eliminate the saddle-point matrix, found once.
#include "elimination_order.hpp"

#include <algorithm>
#include <utility>

#include "shallow_order.hpp"

namespace mbs::csc_klu {
namespace {

/// The coordinates in one column of the saddle-point matrix: its first entries.
struct Coordinates {
  const int* first;
  const int* last;

  Coordinates(const Pattern& saddle, int n, int col)
      : first(saddle.row.data() + saddle.column_begin[col]),
        last(std::lower_bound(first, saddle.row.data() + saddle.column_begin[col + 1], n)) {}
  [[nodiscard]] const int* begin() const { return first; }
  [[nodiscard]] const int* end() const { return last; }
};

/// The pattern of T: that of T_0, and all pairs of coordinates of a constraint.
Pattern tangent_pattern(const Pattern& saddle, int n) {
  std::vector<Pattern::Position> positions;
  for (int col = 0; col < n; ++col) {
    for (const int row : Coordinates(saddle, n, col)) positions.push_back({row, col});
  }
  for (int multiplier = n; multiplier < saddle.columns(); ++multiplier) {
    const Coordinates coordinates(saddle, n, multiplier);
    for (const int col : coordinates) {
      for (const int row : coordinates) positions.push_back({row, col});
    }
  }
  return Pattern(n, std::move(positions));
}

}  // namespace

std::vector<int> interleaved_order(const Pattern& saddle, int n) {
  const std::vector<int> coordinates = shallow_order(tangent_pattern(saddle, n));
  std::vector<int> rank(n);
  for (int k = 0; k < n; ++k) rank[coordinates[k]] = k;

  // Multipliers that follow the coordinate of a rank; those without coordinates follow the first.
  std::vector<std::vector<int>> followers(n);
  for (int multiplier = n; multiplier < saddle.columns(); ++multiplier) {
    int last = 0;
    for (const int row : Coordinates(saddle, n, multiplier)) last = std::max(last, rank[row]);
    followers[last].push_back(multiplier);
  }
  std::vector<int> order;
  order.reserve(saddle.columns());
  for (int k = 0; k < n; ++k) {
    order.push_back(coordinates[k]);
    order.insert(order.end(), followers[k].begin(), followers[k].end());
  }
  return order;
}

}  // namespace mbs::csc_klu
