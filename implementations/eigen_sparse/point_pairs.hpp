// Differences of two pairs of points, and rows of derivatives by their coordinates.
#pragma once

#include <array>
#include <vector>

#include "coordinates.hpp"

namespace mbs::eigen_sparse {

/// Four points a, b, c, d, of which any may coincide or be fixed, as what u = r_a - r_b and
/// w = r_c - r_d need. Each free point has its part in a row of derivatives once:
/// weights[2i] (derivative by u) + weights[2i + 1] (derivative by w) for the i-th.
struct PointPairs {
  PointPairs(const Coordinates& coordinates, const std::array<int, 4>& points);

  /// r_a - r_b and r_c - r_d for any `x` (extended): positions, velocities, accelerations.
  template <int kDimension>
  void differences(const double* x, double* ab, double* cd) const {
    for (int axis = 0; axis < kDimension; ++axis) {
      ab[axis] = x[ends[axis]] - x[ends[kDimension + axis]];
      cd[axis] = x[ends[2 * kDimension + axis]] - x[ends[3 * kDimension + axis]];
    }
  }

  /// Writes the row with derivatives `by_ab` and `by_cd`; returns the end of what it wrote.
  template <int kDimension>
  double* write_row(const double* by_ab, const double* by_cd, double* row) const {
    for (int i = 0; i < free_points; ++i) {
      for (int axis = 0; axis < kDimension; ++axis) {
        *row++ = weights[2 * i] * by_ab[axis] + weights[2 * i + 1] * by_cd[axis];
      }
    }
    return row;
  }

  int free_points = 0;
  double weights[8] = {};
  int ends[12] = {};  // coordinates of a, b, c, d
};

template <int kDimension>
double inner(const double* x, const double* y) {
  double sum = 0.0;
  for (int axis = 0; axis < kDimension; ++axis) sum += x[axis] * y[axis];
  return sum;
}

/// B of a bilinear constraint, rows one after another, for the dimension in use.
using Matrix = std::array<double, 9>;

/// The first `dimension` rows and columns.
Matrix packed(const std::array<std::array<double, 3>, 3>& matrix, int dimension);

template <int kDimension>
void multiply(const Matrix& matrix, const double* x, double* result) {
  for (int i = 0; i < kDimension; ++i) {
    result[i] = inner<kDimension>(matrix.data() + kDimension * i, x);
  }
}

template <int kDimension>
void multiply_transposed(const Matrix& matrix, const double* x, double* result) {
  for (int j = 0; j < kDimension; ++j) {
    result[j] = 0.0;
    for (int i = 0; i < kDimension; ++i) result[j] += matrix[kDimension * i + j] * x[i];
  }
}

}  // namespace mbs::eigen_sparse
