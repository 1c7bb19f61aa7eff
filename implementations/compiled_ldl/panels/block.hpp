// A diagonal block of a panel: L D Lᵀ in registers, the inverse of its L, products with triangles.
#pragma once

#include <type_traits>

#include "panels/vectors.hpp"
#include "scalar.hpp"

namespace mbs::compiled_ldl {

/// x w − y² to the last digit, where there are fused multiply-adds (Kahan's two products).
inline double determinant(double x, double y, double w) {
  const double product = y * y;
#ifdef __FP_FAST_FMA
  return __builtin_fma(x, w, -product) - __builtin_fma(y, y, -product);
#else
  return x * w - product;
#endif
}
inline float determinant(float x, float y, float w) {
  return static_cast<float>(static_cast<double>(x) * w - static_cast<double>(y) * y);
}

inline Lanes determinant(const Lanes& x, const Lanes& y, const Lanes& w) {
  Lanes result;
  for (int i = 0; i < Lanes::kCount; ++i) result.v[i] = determinant(x.v[i], y.v[i], w.v[i]);
  return result;
}

/// L D Lᵀ of a symmetric block, columns in registers, of which the lower halves count: a becomes L
/// D, l becomes L, `inverse` that of D; lanes from P on are rows below. Two pivots at a time: both
/// inverses, 1/x and x/det, are under way together. The next two pivots x, w and c between them are
/// found in scalars, since what becomes of the columns is there much later. False if a pivot is not
/// accepted.
template <typename F, int P, bool kDefinite, typename V>
inline bool decompose(V (&a)[P], V (&l)[P], F (&inverse)[P]) {
  bool accepted = true;
  F x = a[0][0], c = P > 1 ? a[0][1] : F(0), w = P > 1 ? a[P > 1 ? 1 : 0][1] : F(0);
#pragma GCC unroll 4
  for (int k = 0; k < P; k += 2) {
    inverse[k] = F(1) / x;
    if (kDefinite) accepted &= x > F(0);
    l[k] = a[k] * inverse[k];
    if (k + 1 == P) {
      accepted &= inverse[k] - inverse[k] == F(0);
      break;
    }
    const F of_pair = F(1) / determinant(x, c, w);
    inverse[k + 1] = x * of_pair;
    if (kDefinite) accepted &= of_pair > F(0);
    accepted &= of_pair - of_pair == F(0) && inverse[k + 1] != F(0);
    const F l_pair = c * inverse[k];
    if (k + 2 < P) {
      const F p = a[k][k + 2], p2 = a[k + 1][k + 2] - p * l_pair;
      x = (a[k + 2][k + 2] - p * (p * inverse[k])) - p2 * p2 * inverse[k + 1];
      if (k + 3 < P) {
        const F r = a[k][k + 3], r2 = a[k + 1][k + 3] - r * l_pair;
        c = (a[k + 2][k + 3] - p * (r * inverse[k])) - p2 * r2 * inverse[k + 1];
        w = (a[k + 3][k + 3] - r * (r * inverse[k])) - r2 * r2 * inverse[k + 1];
      }
    }
    subtract(a[k + 1], a[k], l_pair, k + 1);
    l[k + 1] = a[k + 1] * inverse[k + 1];
#pragma GCC unroll 8
    for (int j = k + 2; j < P; ++j) {
      subtract(a[j], a[k], l[k][j], j);
      subtract(a[j], a[k + 1], l[k + 1][j], j);
    }
  }
  return accepted;
}

/// Inverse of the unit lower triangle l, columns.
template <typename F, int P, typename V>
inline void invert_triangle(const V (&l)[P], V (&m)[P]) {
#pragma GCC unroll 8
  for (int j = 0; j < P; ++j) {
    m[j] = V{};
    set_number(m[j], j, F(1));
  }
#pragma GCC unroll 8
  for (int k = 0; k < P; ++k) {
    V column = l[k];
#pragma GCC unroll 8
    for (int i = 0; i < static_cast<int>(sizeof(V) / sizeof(F)); ++i) {
      if (i <= k || i >= P) set_number(column, i, F(0));
    }
#pragma GCC unroll 8
    for (int j = 0; j <= k; ++j) subtract(m[j], column, m[j][k], k + 1);
  }
}

/// Σ x_j c_j of P columns of N numbers each.
template <typename F, int P, int N>
inline typename Short<F, N>::Type times_columns(const F* columns,
                                                const typename Short<F, N>::Type& x) {
  using V = typename Short<F, N>::Type;
  V even = load<F, N>(columns) * x[0], odd = V{};
#pragma GCC unroll 8
  for (int j = 1; j < P; ++j) {
    V& sum = j % 2 == 0 ? even : odd;
    sum += load<F, N>(columns + j * N) * x[j];
  }
  return even + odd;
}

/// The same of a lower or an upper triangle in columns of two registers, without most of its zeros.
template <bool kLower, int P, typename X>
inline Halves times_triangle(const double* columns, const X& x) {
  Halves even = {}, odd = {};
#pragma GCC unroll 8
  for (int j = 0; j < P; ++j) {
    Halves& sum = j % 2 == 0 ? even : odd;
    const auto take = [&](Halves::Four& of_half, int from) {
      const auto product = load<double, 4>(columns + j * 8 + from) * x[j];
      of_half = j < (kLower ? 0 : from) + 2 ? product : of_half + product;
    };
    if (!kLower || j < 4) take(sum.low, 0);
    if (kLower ? P > 4 : j >= 4) take(sum.high, 4);
  }
  return even + odd;
}

/// Of a lower triangle, N numbers a column; x: in memory.
template <typename F, int P, int N>
inline typename Short<F, N>::Type times_lower(const F* columns, const F* x) {
  using V = typename Short<F, N>::Type;
  if constexpr (std::is_same_v<V, Halves>) {
    return times_triangle<true, P>(columns, x);
  } else {
    V sum = load<F, N>(columns) * x[0];
#pragma GCC unroll 8
    for (int j = 1; j < P; ++j) sum += load<F, N>(columns + j * N) * x[j];
    return sum;
  }
}

/// Of an upper triangle.
template <typename F, int P, int N>
inline typename Short<F, N>::Type times_upper(const F* columns,
                                              const typename Short<F, N>::Type& x) {
  if constexpr (std::is_same_v<typename Short<F, N>::Type, Halves>) {
    return times_triangle<false, P>(columns, x);
  } else {
    return times_columns<F, P, N>(columns, x);
  }
}

}  // namespace mbs::compiled_ldl
