// In which order the unknowns are eliminated.
#pragma once

#include <utility>
#include <vector>

namespace mbs::csc_ldl {

/// What of a symmetric matrix decides its order.
struct EliminationProblem {
  int variables = 0;  ///< the first unknowns
  int rows = 0;       ///< the others: rows of constraints, each to come after all of its variables
  std::vector<std::pair<int, int>> entries;  ///< off the diagonal, either half, any order, repeats
};

enum class Order {
  lowest_tree,  ///< AMD's fill, with the lowest elimination tree
  amd,          ///< AMD's order as it is
};

/// The unknowns in the order of elimination.
std::vector<int> elimination_order(const EliminationProblem& problem, Order kind);

}  // namespace mbs::csc_ldl
