// The pattern of the saddle-point matrix and where its values are, found once.
#pragma once

#include <array>
#include <vector>

#include "element_shares.hpp"
#include "hessians.hpp"
#include "jacobian_pattern.hpp"
#include "shallow_order.hpp"
#include "storage.hpp"

namespace mbs::csc_klu {

/// The pattern of Eq. (12), both triangles: n coordinates, then m multipliers in the order of
/// JacobianPattern. Example, one distance from a fixed point to B, planar: columns 0 and 1 have
/// rows 0, 1 (M) and 2, column 2 has rows 0, 1 (the Jacobian block, from `above` on) and 2 (-eps).
template <int dim>
struct SaddlePattern {
  /// Where a Jacobian block goes.
  struct Block {
    int row;                     ///< its constraint
    int above;                   ///< offset of its first value in the multiplier's column
    std::array<int, dim> below;  ///< offset in each column of the point, in the multiplier's row
  };
  /// A coefficient of a linear constraint, Eq. (8): a constant.
  struct Constant {
    int row;
    int above, below;  ///< offsets
    double coefficient;
  };

  /// `elements`: those that give C and K; `hessians`: what Eq. (16) adds to K, or nothing.
  SaddlePattern(const Model& model, const JacobianPattern<dim>& jacobian,
                const std::vector<ElementBlock>& elements,
                const std::vector<HessianEntry>& hessians, Order elimination = Order::shallow);

  Pattern pattern;
  std::vector<int> order;           ///< of elimination
  std::vector<Block> blocks;        ///< one for each block of the JacobianPattern
  std::vector<Constant> constants;  ///< all coefficients of the linear constraints
  std::vector<int> diagonal;        ///< m; offsets of -eps
  ElementShares<dim> shares;        ///< C and K
};

}  // namespace mbs::csc_klu
