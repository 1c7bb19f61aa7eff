// Arithmetic on the D numbers of a point or direction.
#pragma once

#include <array>

namespace mbs::csc_umfpack {

using Matrix = std::array<std::array<double, 3>, 3>;  ///< [row][column]; planar: the upper left

template <int D>
struct Vector {
  double components[D];

  double& operator[](int k) { return components[k]; }
  double operator[](int k) const { return components[k]; }
};

/// x_a - x_b for offsets a and b.
template <int D>
Vector<D> difference(const double* x, int a, int b) {
  Vector<D> u;
  for (int k = 0; k < D; ++k) u[k] = x[a + k] - x[b + k];
  return u;
}

template <int D>
double dot(const Vector<D>& u, const Vector<D>& w) {
  double sum = 0.0;
  for (int k = 0; k < D; ++k) sum += u[k] * w[k];
  return sum;
}

template <int D>
Vector<D> operator*(double factor, Vector<D> u) {
  for (int k = 0; k < D; ++k) u[k] *= factor;
  return u;
}

template <int D>
Vector<D> operator+(Vector<D> u, const Vector<D>& w) {
  for (int k = 0; k < D; ++k) u[k] += w[k];
  return u;
}

/// B w.
template <int D>
Vector<D> product(const Matrix& B, const Vector<D>& w) {
  Vector<D> result{};
  for (int i = 0; i < D; ++i) {
    for (int j = 0; j < D; ++j) result[i] += B[i][j] * w[j];
  }
  return result;
}

/// B^T u.
template <int D>
Vector<D> transposed_product(const Matrix& B, const Vector<D>& u) {
  Vector<D> result{};
  for (int i = 0; i < D; ++i) {
    for (int j = 0; j < D; ++j) result[j] += B[i][j] * u[i];
  }
  return result;
}

/// z x w; planar: z = (0, 0, 1), whatever `z` points to.
template <int D>
Vector<D> cross(const double* z, const Vector<D>& w) {
  if constexpr (D == 2) {
    return {{-w[1], w[0]}};
  } else {
    return {{z[1] * w[2] - z[2] * w[1], z[2] * w[0] - z[0] * w[2], z[0] * w[1] - z[1] * w[0]}};
  }
}

/// y (D) += factor u.
template <int D>
void add(double factor, const Vector<D>& u, double* y) {
  for (int k = 0; k < D; ++k) y[k] += factor * u[k];
}

}  // namespace mbs::csc_umfpack
