// Dense fronts of an order of elimination, neighbours merged where that is predicted to save time.
#pragma once

#include <vector>

#include "ordering.hpp"

namespace mbs::compiled_ldl {

struct TreeFront {
  std::vector<int> pivots;  ///< nodes, in order of elimination
  std::vector<int> border;  ///< nodes, in no order
};
struct Tree {
  std::vector<TreeFront> fronts;  ///< in order of elimination
  double cycles = 0.0;            ///< predicted time of a factorization
};

/// `sizes`: rows of each node.
Tree eliminate(const Graph& graph, const std::vector<int>& order, const std::vector<int>& sizes,
               int width);

}  // namespace mbs::compiled_ldl
