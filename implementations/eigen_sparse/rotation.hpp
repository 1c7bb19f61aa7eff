// Axes that torques turn about.
#pragma once

#include <array>

#include "coordinates.hpp"

namespace mbs::eigen_sparse {

/// Where the unit vector z is in an extended position; planar: unused.
using Axis = std::array<int, 3>;

inline Axis axis_of(const Coordinates& coordinates, int point) {
  if (coordinates.dimension() == 2) return {};
  return {coordinates.of_point(point, 0), coordinates.of_point(point, 1),
          coordinates.of_point(point, 2)};
}

/// result = z x w, with z = (0, 0, 1) in the plane; `q` extended.
template <int kDimension>
void turn(const Axis& axis, const double* q, const double* w, double* result) {
  if constexpr (kDimension == 2) {
    result[0] = -w[1];
    result[1] = w[0];
  } else {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      result[i] = q[axis[j]] * w[k] - q[axis[k]] * w[j];
    }
  }
}

}  // namespace mbs::eigen_sparse
