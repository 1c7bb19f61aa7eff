// Differences of points and their products, in two or three dimensions.
#pragma once

#include <array>

namespace mbs::armadillo_dense {

template <int dimension>
using Direction = std::array<double, dimension>;

/// x_a - x_b, with a and b the starts of two points in the extended vector x.
template <int dimension>
Direction<dimension> difference(const double* x, int a, int b) {
  Direction<dimension> result;
  for (int k = 0; k < dimension; ++k) result[k] = x[a + k] - x[b + k];
  return result;
}

template <int dimension>
double dot(const Direction<dimension>& u, const Direction<dimension>& w) {
  double sum = 0.0;
  for (int k = 0; k < dimension; ++k) sum += u[k] * w[k];
  return sum;
}

/// z x w with the unit vector z that starts at `axis` in x (planar: (0, 0, 1), `axis` is unused).
template <int dimension>
Direction<dimension> turned(const double* x, int axis, const Direction<dimension>& w) {
  if constexpr (dimension == 2) {
    return {-w[1], w[0]};
  } else {
    const double* const z = x + axis;
    return {z[1] * w[2] - z[2] * w[1], z[2] * w[0] - z[0] * w[2], z[0] * w[1] - z[1] * w[0]};
  }
}

}  // namespace mbs::armadillo_dense
