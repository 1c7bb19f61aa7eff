// Where points are in coordinate vectors that driven and fixed points extend.
#pragma once

#include <array>
#include <vector>

#include "matrix.hpp"
#include "mbs/model.hpp"

namespace mbs::starting_dense {

/// What one point has in two differences r_a - r_b and r_c - r_d: for instance ab = 1 if it is a.
struct Share {
  int at;  ///< of the point in extended coordinates
  double ab, cd;
};

/// Coordinates and velocities are taken *extended*: the n entries of q (or v), then the driven
/// points, the fixed points and, planar, the axis (0, 0, 1); velocities have zeros there but for
/// driven points. So every point is addressed like a free one:
///
///   A fixed at (0, 7), B and C free, D driven:  extended q = (Bx By Cx Cy | Dx Dy | 0 7 | 0 0 1),
///   B at 0, C at 2, D at 4, A at 6, axis at 8; variables = 4, moving = 6.
struct Layout {
  explicit Layout(const Model& model);

  /// Where the unit vector `point` is; -1: the planar axis.
  [[nodiscard]] int axis(int point) const { return point < 0 ? planar_axis : at[point]; }
  /// Shares of the points a, b, c, d before entry `end` (of extended coordinates), each point once.
  [[nodiscard]] std::vector<Share> shares(const std::array<int, 4>& points, int end) const;

  int dimension;
  int variables;         ///< n
  int moving;            ///< n and the coordinates of driven points
  std::vector<int> at;   ///< of each point
  int planar_axis = -1;  ///< where (0, 0, 1) is
  Vector position;       ///< extended coordinates at t = 0; constant from entry `moving` on
};

}  // namespace mbs::starting_dense
