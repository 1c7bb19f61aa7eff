// In which order the unknowns are eliminated.
#pragma once

#include <utility>
#include <vector>

namespace mbs::csc_ldl {

/// What of a symmetric matrix decides its order.
struct EliminationProblem {
  int size = 0;
  std::vector<std::pair<int, int>> entries;  ///< off the diagonal, either half, any order, repeats
  /// Rows of constraints as unknowns: each has to wait until one of these sets of variables, the
  /// coordinates of its points, is eliminated. Empty: no need to wait.
  std::vector<std::vector<int>> block;  ///< of a set: its unknowns
  std::vector<std::vector<int>> waits_for;  ///< of an unknown: sets, any one of which will do
};

/// The unknowns in the order of elimination.
std::vector<int> elimination_order(const EliminationProblem& problem);

}  // namespace mbs::csc_ldl
