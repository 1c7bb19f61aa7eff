// How long a scene's parts are, point by point.
#pragma once

#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// For each point the shortest difference of points that a quadratic constraint takes there, at the
/// start, m; 0 if there is none.
std::vector<double> shortest_lengths(const Model& model);

}  // namespace mbs
