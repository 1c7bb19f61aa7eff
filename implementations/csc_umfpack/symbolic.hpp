// What is known of T before any value is: its pattern and schedules, built once.
//
// A numeric type of assembly.hpp is made from one of these and cannot be made without it. They and
// the layouts hold all searching and all branching, so that the step has none.
#pragma once

#include <vector>

#include "coupling.hpp"
#include "force_layout.hpp"
#include "layout.hpp"
#include "pattern.hpp"

namespace mbs::csc_umfpack {

/// The pattern of T, the union of those of M, Phi_q^T Phi_q, C and K, and two schedules. The rank-k
/// update: for every D x D block of T that constraints or elements reach, which pairs of blocks of
/// Phi_q are multiplied and where the result goes; a block of elements alone has no pairs. And the
/// places of the elements.
template <int D>
struct TangentSchedule {
  struct Block {
    int first = 0, last = 0;  ///< its pairs
    Place<D> place;
  };
  /// Blocks of Phi_q: the product is (block `row`) (block `col`)^T.
  struct Pair {
    int row = 0, col = 0;
  };

  TangentSchedule(const SparsityPattern& mass, const JacobianLayout& layout,
                  const ForceLayout& forces);

  SparsityPattern pattern;
  std::vector<Block> diagonal, lower;  ///< pairs of `diagonal` come first
  std::vector<Pair> pairs;
  std::vector<Place<D>> places;  ///< of the elements, see element_places()
};

}  // namespace mbs::csc_umfpack
