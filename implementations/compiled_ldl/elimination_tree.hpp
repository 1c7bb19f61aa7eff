// Dense fronts of an order of elimination, neighbours merged where that is predicted to save time.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "ordering.hpp"

namespace mbs::compiled_ldl {

/// Three nodes in a row, 0 - 1 - 2, in the order {0, 2, 1} give the fronts {pivots 0, border 1},
/// {2, 1} and {1, none}, and fill = 2; or one front of all pivots where that takes less time.
struct TreeFront {
  std::vector<int> pivots;  ///< nodes, in order of elimination
  std::vector<int> border;  ///< nodes, in no order
};
struct Tree {
  std::vector<TreeFront> fronts;  ///< in order of elimination
  double cycles = 0.0;            ///< predicted time of a factorization
  std::size_t fill = 0;           ///< blocks below the diagonal, before fronts were merged
};

/// `sizes`: rows of each node. Without fronts if the fill is above `most`.
Tree eliminate(const Graph& graph, const std::vector<int>& order, const std::vector<int>& sizes,
               int width, std::size_t most = std::numeric_limits<std::size_t>::max());

/// Cycles in which a front keeps the processor busy, and those in which what depends on it waits
/// while fronts next to it that do not may go on. Three of {10, 5}, each waiting for the one
/// before, take 45. If the second does not wait for the first, and the third waits for both, they
/// take 40.
struct FrontTime {
  double work = 0.0, latency = 0.0;
};

/// How often registers are filled for a pack of `width` numbers; one number is no pack.
double turns_of_pack(int width);

/// Of a front with `pivots` columns and `border` more rows, which are those of `nodes` nodes.
/// `width`: how many numbers a processor handles at once.
FrontTime front_time(int pivots, int border, int nodes, int width);

/// Of fronts one after the other; `parents`: which later front waits for each, -1: none.
double predicted_cycles(const std::vector<FrontTime>& fronts, const std::vector<int>& parents);

}  // namespace mbs::compiled_ldl
