// Small scenes: L D Lᵀ of the whole matrix in registers, solved for a right-hand side on the way.
#pragma once

#include "small_rows.hpp"

namespace mbs::compiled_ldl {

/// Stored are D⁻¹ and M = L⁻¹ by rows, and by columns once they are asked for.
template <int N>
class SmallFactors {
 public:
  using Row = SmallRow<N>;

  /// T x = y; false if a pivot is not positive.
  bool factorize_and_solve(const SmallMatrix<N>& matrix, Row y, Row& x);
  /// Before the first solve() with new factors.
  void prepare();
  [[nodiscard]] Row solve(const Row& y) const;

 private:
  static constexpr int kLanes = Row::kLanes, kVectors = Row::kVectors, kSize = Row::kSize;
  using V = typename Row::V;

  alignas(64) double rows_[kSize * kSize] = {};
  alignas(64) double columns_[kSize * kSize] = {};
  alignas(64) double inverse_[kSize] = {};
};

/// As decompose() of panel_vectors.hpp. Row k of M is e_k less the multiples of those before it
/// that L tells, so that x = Mᵀ D⁻¹ M y is complete when the last pivot is.
template <int N>
bool SmallFactors<N>::factorize_and_solve(const SmallMatrix<N>& matrix, Row y, Row& x) {
  Row a[N], m[N];
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) {
    a[j] = matrix.column[j];
    m[j] = Row::zero();
    m[j].v[j / kLanes][j % kLanes] = 1.0;
  }
  x = Row::zero();
  bool accepted = true;
#pragma GCC unroll 8
  for (int k = 0; k < N; k += 2) {
    const int at = k / kLanes, i = k % kLanes;
    const double p = a[k].v[at][i], c = a[k].v[at][i + 1], w = a[k + 1].v[at][i + 1];
    const double of_pair = 1.0 / determinant(p, c, w);
    const double inverse = 1.0 / p, inverse1 = p * of_pair;
    accepted &= p > 0.0 && of_pair > 0.0 && of_pair - of_pair == 0.0;
    const double l = c * inverse;
    Row l0, l1;
    for (int r = at; r < kVectors; ++r) {
      l0.v[r] = a[k].v[r] * inverse;
      a[k + 1].v[r] -= a[k].v[r] * l;
      l1.v[r] = a[k + 1].v[r] * inverse1;
    }
    for (int r = 0; r <= at; ++r) m[k + 1].v[r] -= l * m[k].v[r];
    const double y0 = y.v[at][i], y1 = y.v[at][i + 1] - l * y0;
    const double z0 = y0 * inverse, z1 = y1 * inverse1;
    for (int r = at; r < kVectors; ++r) y.v[r] = (y.v[r] - a[k].v[r] * z0) - a[k + 1].v[r] * z1;
    for (int r = 0; r <= at; ++r) x.v[r] += m[k].v[r] * z0 + m[k + 1].v[r] * z1;
    inverse_[k] = inverse;
    inverse_[k + 1] = inverse1;
#pragma GCC unroll 16
    for (int j = k + 2; j < N; ++j) {
      const double f0 = l0.v[j / kLanes][j % kLanes], f1 = l1.v[j / kLanes][j % kLanes];
      for (int r = j / kLanes; r < kVectors; ++r) {
        a[j].v[r] = (a[j].v[r] - a[k].v[r] * f0) - a[k + 1].v[r] * f1;
      }
      for (int r = 0; r <= at; ++r) m[j].v[r] = (m[j].v[r] - m[k].v[r] * f0) - m[k + 1].v[r] * f1;
    }
    m[k].put(rows_ + k * kSize);
    m[k + 1].put(rows_ + (k + 1) * kSize);
  }
  return accepted;
}

template <int N>
void SmallFactors<N>::prepare() {
  for (int r = 0; r < kVectors; ++r) {
    for (int from = r; from < kVectors; ++from) {
      V block[kLanes];
#pragma GCC unroll 8
      for (int i = 0; i < kLanes; ++i) {
        block[i] = load<double, kLanes>(rows_ + (from * kLanes + i) * kSize + r * kLanes);
      }
      store_transposed<double, kLanes, kLanes, kSize>(
          block, columns_ + r * kLanes * kSize + from * kLanes);
    }
  }
}

template <int N>
SmallRow<N> SmallFactors<N>::solve(const Row& y) const {
  alignas(64) double numbers[kSize];
  y.put(numbers);
  Row z[2] = {Row::zero(), Row::zero()}, x[2] = {Row::zero(), Row::zero()};
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) {
    for (int r = j / kLanes; r < kVectors; ++r) {
      z[j % 2].v[r] += load<double, kLanes>(columns_ + j * kSize + r * kLanes) * numbers[j];
    }
  }
  for (int r = 0; r < kVectors; ++r) {
    z[0].v[r] = (z[0].v[r] + z[1].v[r]) * load<double, kLanes>(inverse_ + r * kLanes);
  }
  z[0].put(numbers);
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) {
    for (int r = 0; r <= j / kLanes; ++r) {
      x[j % 2].v[r] += load<double, kLanes>(rows_ + j * kSize + r * kLanes) * numbers[j];
    }
  }
  for (int r = 0; r < kVectors; ++r) x[0].v[r] += x[1].v[r];
  return x[0];
}

}  // namespace mbs::compiled_ldl
