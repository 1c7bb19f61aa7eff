// In which order the unknowns are eliminated.
#pragma once

#include <utility>
#include <vector>

namespace mbs::csc_ldl {

/// What of a symmetric matrix decides its order.
///
/// A row of constraints comes after all of its variables. But one that owns some comes after these
/// alone, and whoever has one of them has the row's others in its place.
struct EliminationProblem {
  int variables = 0;                         ///< the first unknowns
  int rows = 0;                              ///< the others: rows of constraints
  std::vector<std::pair<int, int>> entries;  ///< off the diagonal, either half, any order, repeats
  std::vector<std::vector<int>> owned;  ///< by each row: variables that no other row owns, or none
};

enum class Order {
  lowest_tree,  ///< AMD's fill, with the lowest elimination tree
  amd,          ///< AMD's order as it is
};

/// The unknowns in the order of elimination.
std::vector<int> elimination_order(const EliminationProblem& problem, Order kind);

}  // namespace mbs::csc_ldl
