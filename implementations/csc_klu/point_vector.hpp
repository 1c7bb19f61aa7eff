// Vectors of one point's components: the few operations that constraints and forces need.
#pragma once

#include <array>

namespace mbs::csc_klu {

template <int dim>
using Vector = std::array<double, dim>;
template <int dim>
using SmallMatrix = std::array<Vector<dim>, dim>;  ///< [row][column]

/// x_a - x_b, two points given by their offsets into x.
template <int dim>
Vector<dim> difference(const double* x, int a, int b) {
  Vector<dim> d;
  for (int k = 0; k < dim; ++k) d[k] = x[a + k] - x[b + k];
  return d;
}

template <std::size_t dim>
double dot(const std::array<double, dim>& x, const std::array<double, dim>& y) {
  double sum = 0.0;
  for (std::size_t k = 0; k < dim; ++k) sum += x[k] * y[k];
  return sum;
}

/// B x.
template <std::size_t dim>
std::array<double, dim> product(const std::array<std::array<double, dim>, dim>& B,
                                const std::array<double, dim>& x) {
  std::array<double, dim> y;
  for (std::size_t k = 0; k < dim; ++k) y[k] = dot(B[k], x);
  return y;
}

/// B^T x.
template <std::size_t dim>
std::array<double, dim> transposed_product(const std::array<std::array<double, dim>, dim>& B,
                                           const std::array<double, dim>& x) {
  std::array<double, dim> y{};
  for (std::size_t row = 0; row < dim; ++row) {
    for (std::size_t k = 0; k < dim; ++k) y[k] += B[row][k] * x[row];
  }
  return y;
}

/// y = base + factor x, one column of a block, read before it is written: y may be base.
template <std::size_t dim>
void add_column(const double* base, const std::array<double, dim>& x, double factor, double* y) {
  std::array<double, dim> sum;
  for (std::size_t k = 0; k < dim; ++k) sum[k] = base[k] + factor * x[k];
  for (std::size_t k = 0; k < dim; ++k) y[k] = sum[k];
}

/// factor z x w; planar, z = (0, 0, 1) and the argument is not read.
inline Vector<2> cross(const double*, const Vector<2>& w, double factor) {
  return {-factor * w[1], factor * w[0]};
}
inline Vector<3> cross(const double* z, const Vector<3>& w, double factor) {
  return {factor * (z[1] * w[2] - z[2] * w[1]), factor * (z[2] * w[0] - z[0] * w[2]),
          factor * (z[0] * w[1] - z[1] * w[0])};
}

}  // namespace mbs::csc_klu
