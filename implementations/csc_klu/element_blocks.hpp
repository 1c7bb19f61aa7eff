// Which blocks of T the springs couple, found once.
#pragma once

#include <vector>

#include "force_pattern.hpp"

namespace mbs::csc_klu {

/// What one element adds to block (p, q) of T: a product of the gradients of two of its ends.
struct ElementBlock {
  int p, q;  ///< free points: p owns q[dim p .. dim p + dim)
  int element, left, right;
  double sign;  ///< TangentPattern::Share
};

/// All of them, those of one block next to each other, blocks sorted by q, then p.
[[nodiscard]] std::vector<ElementBlock> element_blocks(const ForcePattern& forces, int dim);

}  // namespace mbs::csc_klu
