// In which order to eliminate the saddle-point matrix, found once.
#include "elimination_order.hpp"

#include <algorithm>
#include <utility>

#include "filled_graph.hpp"
#include "minimum_degree.hpp"
#include "precedence.hpp"

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

/// What multipliers have to wait for; coordinates wait for nothing.
Precedence precedence_of_rows(const Pattern& saddle, int n, const std::vector<Owned>& owned) {
  Precedence precedence(saddle.columns());
  std::vector<int> owner(n, -1);  // by coordinate: a multiplier
  for (int multiplier = n; multiplier < saddle.columns(); ++multiplier) {
    const auto [first, count] = owned[multiplier - n];
    std::fill_n(owner.begin() + first, count, multiplier);
  }
  for (int multiplier = n; multiplier < saddle.columns(); ++multiplier) {
    const auto [first, count] = owned[multiplier - n];
    for (int i = first; i < first + count; ++i) precedence.add(i, multiplier);
    if (count > 0) continue;
    for (const int i : Coordinates(saddle, n, multiplier)) {
      precedence.add(i, multiplier);
      if (owner[i] < 0) continue;
      for (const int other : Coordinates(saddle, n, owner[i])) precedence.add(other, multiplier);
    }
  }
  return precedence;
}

/// T's order for the coordinates, every multiplier as soon as it may come.
std::vector<int> interleaved_order(const Pattern& saddle, int n, Precedence precedence,
                                   Order of_tangent) {
  std::vector<int> order;
  const auto append = [&](int multiplier) { order.push_back(multiplier); };
  for (int multiplier = n; multiplier < saddle.columns(); ++multiplier) {
    if (precedence.is_free(multiplier)) append(multiplier);
  }
  for (const int i : ordered(tangent_pattern(saddle, n), of_tangent)) {
    order.push_back(i);
    precedence.take_out(i, append);
  }
  return order;
}

/// Multiplications of a factorization and three solutions.
long long work(const Pattern& saddle, const std::vector<int>& order) {
  long long sum = 0;
  for (const std::vector<int>& column : FilledGraph(saddle, order).later) {
    const long long length = std::ssize(column);
    sum += length * length + 3 * 2 * length;
  }
  return sum;
}

}  // namespace

std::vector<int> saddle_order(const Pattern& saddle, int n, const std::vector<Owned>& owned,
                              Order order) {
  const Precedence precedence = precedence_of_rows(saddle, n, owned);
  std::vector<int> interleaved = interleaved_order(saddle, n, precedence, order);
  if (order != Order::shallow) return interleaved;
  std::vector<int> by_degree = minimum_degree_order(saddle, precedence);
  return work(saddle, by_degree) < work(saddle, interleaved) ? by_degree : interleaved;
}

}  // namespace mbs::csc_klu
