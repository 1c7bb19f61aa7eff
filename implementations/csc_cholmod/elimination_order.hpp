// Orders of elimination with little fill and low trees.
#pragma once

#include <vector>

#include "pattern.hpp"

namespace mbs::csc_cholmod {

/// What is eliminated before node v: `before[v]`, each once.
using Before = std::vector<std::vector<int>>;

/// The order of n nodes that costs least, linked at `positions`: out of `order`, which keeps
/// `before`, and minimum degree in rounds. A round eliminates nodes that no edge links. Either gets
/// the lowest elimination tree that its fill allows. Where much fills `order` stays. Node v becomes
/// `result[v]`.
///
/// Example, the chain 0-1-2-3-4: result = {0, 2, 4, 3, 1} or the like, 0 and 4 first, 2 last.
std::vector<int> low_order(int n, const std::vector<Position>& positions,
                           const std::vector<int>& order, const Before& before);

}  // namespace mbs::csc_cholmod
