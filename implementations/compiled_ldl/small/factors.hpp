// Small scenes: L D Lᵀ of the whole matrix in registers, solved for a right-hand side on the way.
#pragma once

#include "panels/block.hpp"
#include "panels/vectors.hpp"
#include "small/rows.hpp"

namespace mbs::compiled_ldl {

/// Stored are D⁻¹ and M = L⁻¹ by rows, and by columns once they are asked for. Of [4 1; 1 3], with
/// L = [1 0; ¼ 1] and D = (4, 11/4): inverse_ = {¼, 4/11}, rows_ = {1 0}, {−¼ 1}.
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

  struct Pair {
    double p, c, w;
  };
  static Pair next_pair(const Row (&a)[N], const Row& b, int k, double inverse, double of_pair);

  alignas(64) double rows_[kSize * kSize] = {};
  alignas(64) double columns_[kSize * kSize] = {};
  alignas(64) double inverse_[kSize] = {};
};

/// What becomes of the two pivots after k and k + 1, in scalars: that takes less than getting it
/// out of vectors, and the next pair waits for it.
template <int N>
inline typename SmallFactors<N>::Pair SmallFactors<N>::next_pair(const Row (&a)[N], const Row& b,
                                                                 int k, double inverse,
                                                                 double of_pair) {
  const int next = (k + 2) / kLanes, n = (k + 2) % kLanes;
  const double f = a[k].v[next][n], g = a[k].v[next][n + 1];
  const double fb = b.v[next][n], gb = b.v[next][n + 1];
  const auto eliminated = [&](double x, double of_a, double of_b) {
    return (x - of_a * inverse) - of_b * inverse * of_pair;
  };
  return {eliminated(a[k + 2].v[next][n], f * f, fb * fb),
          eliminated(a[k + 2].v[next][n + 1], f * g, fb * gb),
          eliminated(a[k + 3].v[next][n + 1], g * g, gb * gb)};
}

/// Two pivots p, w with c between them at a time, as decompose() of panels/block.hpp does, but
/// with b = p a' for the column a' = a_{k+1} − (c/p) a_k, which needs no division and is as exact:
/// what the pair subtracts is a_k a_kᵀ/p + b bᵀ/(p det), so that of one pair to the next only 1/det
/// is waited for. Row k of M is e_k less the multiples of those before it that L
/// tells, so that x = Mᵀ D⁻¹ M y is complete when the last pivot is.
template <int N>
bool SmallFactors<N>::factorize_and_solve(const SmallMatrix<N>& matrix, Row y, Row& x) {
  Row a[N], m[N];
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) {
    for (int r = 0; r < kVectors; ++r) a[j].v[r] = matrix.column[j].v[r];
    for (int r = 0; r < kVectors; ++r) m[j].v[r] = V{};
    m[j].v[j / kLanes][j % kLanes] = 1.0;
  }
  Row sum = Row::zero();
  bool accepted = true;
  Pair pair = {a[0].v[0][0], a[0].v[0][1], a[1].v[0][1]};
#pragma GCC unroll 8
  for (int k = 0; k < N; k += 2) {
    const int at = k / kLanes, i = k % kLanes;
    const auto [p, c, w] = pair;
    const double of_pair = 1.0 / determinant(p, c, w), inverse = 1.0 / p;
    accepted &= (p > 0.0) & (of_pair > 0.0) & (of_pair - of_pair == 0.0);
    Row b, l0, b0, s;
    for (int r = at; r < kVectors; ++r) {
      b.v[r] = p * a[k + 1].v[r] - c * a[k].v[r];
      l0.v[r] = a[k].v[r] * inverse;
      b0.v[r] = b.v[r] * inverse;
      s.v[r] = b.v[r] * (inverse * of_pair);
    }
    const double y0 = y.v[at][i], yb = p * y.v[at][i + 1] - c * y0;
    Row m0, m1;
    for (int r = 0; r <= at; ++r) {
      m[k + 1].v[r] -= (c * inverse) * m[k].v[r];
      m0.v[r] = m[k].v[r] * inverse;
      m1.v[r] = m[k + 1].v[r] * of_pair;
      sum.v[r] += m0.v[r] * y0 + (m[k + 1].v[r] * yb) * of_pair;
    }
    for (int r = at; r < kVectors; ++r) y.v[r] = (y.v[r] - l0.v[r] * y0) - s.v[r] * yb;
    inverse_[k] = inverse;
    inverse_[k + 1] = p * of_pair;
    for (int r = 0; r <= at; ++r) {  // what lies right of it stays zero
      store<double, kLanes>(rows_ + k * kSize + r * kLanes, m[k].v[r]);
      store<double, kLanes>(rows_ + (k + 1) * kSize + r * kLanes, m[k + 1].v[r]);
    }
    alignas(64) double work[2 * kSize];
    for (int r = at; r < kVectors; ++r) {
      store<double, kLanes>(work + r * kLanes, a[k].v[r]);
      store<double, kLanes>(work + kSize + r * kLanes, b.v[r]);
    }
    const double* numbers = work;  // a load is cheaper than getting a number out of a vector
    asm volatile("" : "+r"(numbers) : : "memory");
    if (k + 2 < N) pair = next_pair(a, b, k, inverse, of_pair);
#pragma GCC unroll 16
    for (int j = k + 2; j < N; ++j) {
      const double f = j < k + 4 ? a[k].v[j / kLanes][j % kLanes] : numbers[j];
      const double fb = j < k + 4 ? b.v[j / kLanes][j % kLanes] : numbers[kSize + j];
      for (int r = j / kLanes; r < kVectors; ++r) {
        a[j].v[r] -= l0.v[r] * f;
        if (j < k + 4) {
          a[j].v[r] -= (b0.v[r] * fb) * of_pair;
        } else {
          a[j].v[r] -= s.v[r] * fb;
        }
      }
      for (int r = 0; r <= at; ++r) m[j].v[r] = (m[j].v[r] - m0.v[r] * f) - m1.v[r] * fb;
    }
  }
  x = sum;
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
