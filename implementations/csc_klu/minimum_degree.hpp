// A minimum-degree order in which some vertices wait for others.
#pragma once

#include <vector>

#include "precedence.hpp"
#include "storage.hpp"

namespace mbs::csc_klu {

/// Always eliminates, of the vertices that need not wait, the one with the fewest neighbours left;
/// of several, the one lowest in the elimination tree. Neighbours of it that have none but the
/// others of its neighbours follow at once. `pattern` is symmetric.
///
/// Example, a chain of five without anything to wait for: 0 4 1 3 2.
[[nodiscard]] std::vector<int> minimum_degree_order(const Pattern& pattern, Precedence precedence);

}  // namespace mbs::csc_klu
