// Which coordinates constraints and elements couple, and where their blocks are in a matrix.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "force_layout.hpp"
#include "layout.hpp"
#include "pattern.hpp"

namespace mbs::csc_umfpack {

/// Where a D x D block of a symmetric matrix and its transposed block are; the same place on the
/// diagonal.
template <int D>
struct Place {
  /// By first coordinates of the block, which the pattern must have.
  Place(const SparsityPattern& pattern, int row, int col);

  std::array<int, D> position{};  ///< where each of its columns starts, in the values
  std::array<int, D> mirrored{};  ///< the same for the transposed block
};

/// The free points of every spring and torsion spring, as ranges of ForceLayout::ends.
std::vector<std::span<const PointLayout::Signs>> elements(const ForceLayout& forces);

/// The coordinates of every row of Phi_q, ascending.
Lists row_coordinates(const JacobianLayout& layout, int dimension);
/// Appends the coordinates of every spring and torsion spring.
void add_element_coordinates(const ForceLayout& forces, int dimension, Lists& sets);

/// For springs, then torsion springs: (end i, end j) with j = 0 ... i, for every end i.
template <int D>
std::vector<Place<D>> element_places(const SparsityPattern& pattern, const ForceLayout& forces);

}  // namespace mbs::csc_umfpack
