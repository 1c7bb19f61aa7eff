// Orders of elimination that MUMPS does not find by itself.
#pragma once

#include <vector>

#include "pattern.hpp"

namespace mbs::csc_mumps {

/// When each variable of `pattern`, whose entries may be repeated, is eliminated, from 1.
/// Nested dissection by METIS, which Debian's MUMPS is built without:
std::vector<int> metis_positions(const Triplets& pattern);
/// Minimum degree; of those that have the least, one that is lowest in the elimination tree:
std::vector<int> low_tree_positions(const Triplets& pattern);

}  // namespace mbs::csc_mumps
