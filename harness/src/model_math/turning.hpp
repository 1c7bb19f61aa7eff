// How fast the parts of a scene turn, estimated from its start.
#pragma once

#include <vector>

#include "mbs/model.hpp"

namespace mbs {

struct Turning {
  double rate = 0.0;    ///< omega, 1/s; 0 for a scene at rest without forces
  double length = 1.0;  ///< l of the point that turns fastest; of a scene at rest the least l, m
};

/// The fastest of all points: what it moves at now, or after falling freely by the shortest length
/// at it, over that length.
Turning fastest_turning(const Model& model);

/// For each point that length of its part (ConnectedParts), m; infinite where there is none.
std::vector<double> part_lengths(const Model& model);

}  // namespace mbs
