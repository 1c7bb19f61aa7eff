// Another order with the same fill, in which chains of unknowns are eliminated side by side.
#pragma once

#include <vector>

#include "pattern.hpp"

namespace mbs::csc_cholmod {

/// The pattern of a factor L is `filled`, diagonal left out: an order without further fill that
/// starts at all ends of the structure and goes towards its middle, ends taking turns. Unknown i
/// becomes `result[i]`.
///
/// Example, the chain 0-1-2-3-4: result = {0, 2, 4, 3, 1} or the like, 0 and 4 first, 2 last.
std::vector<int> outside_in_order(int n, const std::vector<Position>& filled);

}  // namespace mbs::csc_cholmod
