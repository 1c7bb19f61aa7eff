// The few operations on three numbers that the harness's mechanics needs.
#pragma once

#include <array>
#include <cmath>

namespace mbs {

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<std::array<double, 3>, 3>;  // [row][column]

inline Vector3 operator+(const Vector3& x, const Vector3& y) {
  return {x[0] + y[0], x[1] + y[1], x[2] + y[2]};
}
inline Vector3 operator-(const Vector3& x, const Vector3& y) {
  return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}
inline Vector3 operator*(double factor, const Vector3& x) {
  return {factor * x[0], factor * x[1], factor * x[2]};
}
inline double dot(const Vector3& x, const Vector3& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}
inline double norm(const Vector3& x) { return std::hypot(x[0], x[1], x[2]); }
inline Vector3 cross(const Vector3& x, const Vector3& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}
inline Vector3 multiply(const Matrix3& A, const Vector3& x) {
  return {A[0][0] * x[0] + A[0][1] * x[1] + A[0][2] * x[2],
          A[1][0] * x[0] + A[1][1] * x[1] + A[1][2] * x[2],
          A[2][0] * x[0] + A[2][1] * x[1] + A[2][2] * x[2]};
}
inline constexpr Matrix3 kIdentity{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
inline Matrix3 transposed(const Matrix3& A) {
  return {{{A[0][0], A[1][0], A[2][0]}, {A[0][1], A[1][1], A[2][1]}, {A[0][2], A[1][2], A[2][2]}}};
}
inline Vector3 multiply_transposed(const Matrix3& A, const Vector3& x) {
  return {A[0][0] * x[0] + A[1][0] * x[1] + A[2][0] * x[2],
          A[0][1] * x[0] + A[1][1] * x[1] + A[2][1] * x[2],
          A[0][2] * x[0] + A[1][2] * x[1] + A[2][2] * x[2]};
}

}  // namespace mbs
