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

std::vector<int> interleaved_order(const Pattern& saddle, int n, const std::vector<Owned>& owned) {
  const std::vector<int> coordinates = shallow_order(tangent_pattern(saddle, n));
  std::vector<int> rank(n);
  for (int k = 0; k < n; ++k) rank[coordinates[k]] = k;

  // Multipliers that follow the coordinate of a rank; those without coordinates follow the first.
  std::vector<std::vector<int>> followers(n);
  std::vector<int> last_of, owner(n, -1);  // by row: the last of its coordinates
  for (int multiplier = n; multiplier < saddle.columns(); ++multiplier) {
    const int row = static_cast<int>(last_of.size());
    std::fill_n(owner.begin() + owned[row].first, owned[row].count, row);
    last_of.push_back(0);
    for (const int i : Coordinates(saddle, n, multiplier)) {
      last_of[row] = std::max(last_of[row], rank[i]);
    }
  }
  for (int multiplier = n; multiplier < saddle.columns(); ++multiplier) {
    const auto [first, count] = owned[multiplier - n];
    int last = last_of[multiplier - n];
    for (const int i : Coordinates(saddle, n, multiplier)) {
      if (owner[i] >= 0) last = std::max(last, last_of[owner[i]]);
    }
    if (count > 0) last = *std::max_element(rank.begin() + first, rank.begin() + first + count);
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
