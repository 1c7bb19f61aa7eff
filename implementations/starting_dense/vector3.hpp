// Differences of points as three numbers; planar ones carry z = 0.
#pragma once

#include <array>

#include "matrix.hpp"

namespace mbs::starting_dense {

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<Vector3, 3>;  ///< [row][column]

/// x_a - x_b of the points at `a` and `b` in the extended vector `x` (see Layout).
inline Vector3 difference(const Vector& x, int a, int b, int dimension) {
  Vector3 result{};
  for (int i = 0; i < dimension; ++i) result[i] = x[a + i] - x[b + i];
  return result;
}

inline double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Vector3 scaled(double factor, const Vector3& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

/// B a, and B^T a below.
inline Vector3 product(const Matrix3& B, const Vector3& a) {
  return {dot(B[0], a), dot(B[1], a), dot(B[2], a)};
}

inline Vector3 transposed_product(const Matrix3& B, const Vector3& a) {
  Vector3 result{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result[j] += B[i][j] * a[i];
  }
  return result;
}

}  // namespace mbs::starting_dense
