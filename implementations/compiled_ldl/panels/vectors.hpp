// Short vectors of a panel's width: loads, stores of a part, factorization of a diagonal block.
#pragma once

#include <algorithm>
#include <type_traits>

#include "scalar.hpp"

namespace mbs::compiled_ldl {

/// N numbers in a register; `Loose` ones in memory, wherever they begin.
template <typename F, int N>
struct Short {
  using Type __attribute__((vector_size(N * sizeof(F)))) = F;
  using Loose __attribute__((vector_size(N * sizeof(F)), aligned(sizeof(F)), may_alias)) = F;
};
/// Eight doubles in two registers. In one vector that no register holds they would lie in memory,
/// where what follows waits for each number that is put into it.
struct Halves {
  using Four = Short<double, 4>::Type;
  Four low, high;

  double operator[](int i) const { return i < 4 ? low[i] : high[i - 4]; }
  Halves& operator+=(const Halves& b) { return low += b.low, high += b.high, *this; }
  Halves& operator-=(const Halves& b) { return low -= b.low, high -= b.high, *this; }
  Halves& operator*=(const Halves& b) { return low *= b.low, high *= b.high, *this; }
  Halves& operator*=(double x) { return low *= x, high *= x, *this; }
};
inline Halves operator+(Halves a, const Halves& b) { return a += b; }
inline Halves operator-(Halves a, const Halves& b) { return a -= b; }
inline Halves operator*(Halves a, const Halves& b) { return a *= b; }
inline Halves operator*(Halves a, double x) { return a *= x; }
inline Halves operator*(double x, Halves a) { return a *= x; }
#if !defined(__AVX512F__)
template <>
struct Short<double, 8> {
  using Type = Halves;
};
#endif

template <typename F, int N>
typename Short<F, N>::Type load(const F* x) {
  if constexpr (std::is_same_v<typename Short<F, N>::Type, Halves>) {
    return {load<F, 4>(x), load<F, 4>(x + 4)};
  } else {
    return *reinterpret_cast<const typename Short<F, N>::Loose*>(x);
  }
}
template <typename F, int N>
void store(F* x, const typename Short<F, N>::Type& v) {
  if constexpr (std::is_same_v<typename Short<F, N>::Type, Halves>) {
    store<F, 4>(x, v.low);
    store<F, 4>(x + 4, v.high);
  } else {
    *reinterpret_cast<typename Short<F, N>::Loose*>(x) = v;
  }
}

/// v[i] = x.
template <typename V, typename F>
inline void set_number(V& v, int i, F x) {
  if constexpr (!std::is_same_v<V, Halves>) {
    v[i] = x;
  } else if (i < 4) {
    v.low[i] = x;
  } else {
    v.high[i - 4] = x;
  }
}

/// v −= x w, of which numbers before that of place `from` do not count.
template <typename V, typename F>
inline void subtract(V& v, const V& w, F x, int from) {
  if constexpr (!std::is_same_v<V, Halves>) {
    v -= w * x;
  } else {
    if (from < 4) v.low -= w.low * x;
    v.high -= w.high * x;
  }
}

/// Four of eight numbers, from the first or, `kFrom` 4, from the fifth on.
template <int kFrom, typename V>
inline auto four_of(const V& v) {
  if constexpr (std::is_same_v<V, Halves>) {
    return kFrom == 0 ? v.low : v.high;
  } else {
    return __builtin_shufflevector(v, v, kFrom, kFrom + 1, kFrom + 2, kFrom + 3);
  }
}

/// Lanes of a vector for `columns` pivots, or for that many rows below them.
constexpr int lanes_for(int count) { return count <= 2 ? 2 : count <= 4 ? 4 : 8; }

/// Lanes of the longest vector that a register holds, at most 8.
template <typename F>
inline constexpr int kWidest = std::min<int>(8, 8 * kRegisterDoubles / sizeof(F));

/// The first `count` lanes of v, behind them those of `others`.
template <typename F, int N>
typename Short<F, N>::Type first_lanes_or(const typename Short<F, N>::Type& v,
                                          const typename Short<F, N>::Type& others, int count) {
  if constexpr (std::is_same_v<typename Short<F, N>::Type, Halves>) {
    return {first_lanes_or<F, 4>(v.low, others.low, count),
            first_lanes_or<F, 4>(v.high, others.high, count - 4)};
  } else {
    using Index = std::conditional_t<sizeof(F) == 8, long long, int>;
    using Lanes __attribute__((vector_size(N * sizeof(F)))) = Index;
    Lanes lane;
#pragma GCC unroll 8
    for (int i = 0; i < N; ++i) lane[i] = i;
    return lane < static_cast<Index>(count) ? v : others;
  }
}
/// v with zeros behind its first `count` lanes.
template <typename F, int N>
typename Short<F, N>::Type first_lanes(const typename Short<F, N>::Type& v, int count) {
  return first_lanes_or<F, N>(v, typename Short<F, N>::Type{}, count);
}

/// Stores the first P lanes only, in pieces that later loads can be forwarded from.
template <int P, typename F, typename V>
inline void store_first(F* x, const V& v) {
  constexpr int N = sizeof(V) / sizeof(F);
  if constexpr (P == N) {
    store<F, N>(x, v);
  } else if constexpr (N == 8 && P > 4) {
    store<F, 4>(x, four_of<0>(v));
    store_first<P - 4>(x + 4, four_of<4>(v));
  } else if constexpr (N == 4 && P > 2) {
    store<F, 2>(x, __builtin_shufflevector(v, v, 0, 1));
    x[2] = v[2];
  } else if constexpr (P == 2) {
    store<F, 2>(x, __builtin_shufflevector(v, v, 0, 1));
  } else {
    for (int i = 0; i < P; ++i) x[i] = v[i];
  }
}

/// The first P lanes only, zeros behind them. A longer load would wait for what another front has
/// just stored there.
template <int P, int N, typename F>
inline typename Short<F, N>::Type load_first(const F* x) {
  if constexpr (P == N) {
    return load<F, N>(x);
  } else if constexpr (N == 8) {
    static_assert(P > 4);
    const auto low = load<F, 4>(x), high = load_first<P - 4, 4>(x + 4);
    if constexpr (std::is_same_v<typename Short<F, N>::Type, Halves>) {
      return {low, high};
    } else {
      return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    }
  } else {
    typename Short<F, N>::Type v{};
#pragma GCC unroll 4
    for (int i = 0; i < P; ++i) v[i] = x[i];
    return v;
  }
}

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

/// Σ x_j c_j of P columns of a lower triangle, N numbers each; x: in memory. What is zero of columns
/// in two registers is left out.
template <typename F, int P, int N>
inline typename Short<F, N>::Type times_lower(const F* columns, const F* x) {
  using V = typename Short<F, N>::Type;
  if constexpr (std::is_same_v<V, Halves>) {
    Halves even = {}, odd = {};
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) {
      Halves& sum = j % 2 == 0 ? even : odd;
      const auto take = [&](Halves::Four& of_half, int from) {
        const auto product = load<F, 4>(columns + j * N + from) * x[j];
        of_half = j < 2 ? product : of_half + product;
      };
      if (j < 4) take(sum.low, 0);
      if (P > 4) take(sum.high, 4);
    }
    return even + odd;
  } else {
    V sum = load<F, N>(columns) * x[0];
#pragma GCC unroll 8
    for (int j = 1; j < P; ++j) sum += load<F, N>(columns + j * N) * x[j];
    return sum;
  }
}
/// The same of an upper triangle.
template <typename F, int P, int N>
inline typename Short<F, N>::Type times_upper(const F* columns,
                                              const typename Short<F, N>::Type& x) {
  if constexpr (std::is_same_v<typename Short<F, N>::Type, Halves>) {
    Halves even = {}, odd = {};
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) {
      Halves& sum = j % 2 == 0 ? even : odd;
      const auto take = [&](Halves::Four& of_half, int from) {
        const auto product = load<F, 4>(columns + j * N + from) * x[j];
        of_half = j < from + 2 ? product : of_half + product;
      };
      take(sum.low, 0);
      if (j >= 4) take(sum.high, 4);
    }
    return even + odd;
  } else {
    return times_columns<F, P, N>(columns, x);
  }
}

/// The sums over the lanes of four vectors of four numbers.
template <typename V>
inline V lane_sums(const V& c0, const V& c1, const V& c2, const V& c3) {
  const V a = __builtin_shufflevector(c0, c1, 0, 4, 2, 6) +
              __builtin_shufflevector(c0, c1, 1, 5, 3, 7);
  const V b = __builtin_shufflevector(c2, c3, 0, 4, 2, 6) +
              __builtin_shufflevector(c2, c3, 1, 5, 3, 7);
  return __builtin_shufflevector(a, b, 0, 1, 4, 5) + __builtin_shufflevector(a, b, 2, 3, 6, 7);
}

/// The sums over the lanes of eight vectors.
template <typename F, typename V>
inline typename Short<F, 8>::Type lane_sums(const V (&c)[8]) {
  typename Short<F, 8>::Type sums;
  if constexpr (sizeof(V) == 8 * sizeof(F)) {
    V pairs[4], fours[2];
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
      pairs[i] = __builtin_shufflevector(c[2 * i], c[2 * i + 1], 0, 8, 2, 10, 4, 12, 6, 14) +
                 __builtin_shufflevector(c[2 * i], c[2 * i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
#pragma GCC unroll 2
    for (int i = 0; i < 2; ++i) {
      const V &a = pairs[2 * i], &b = pairs[2 * i + 1];
      fours[i] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13) +
                 __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    }
    sums = __builtin_shufflevector(fours[0], fours[1], 0, 1, 2, 3, 8, 9, 10, 11) +
           __builtin_shufflevector(fours[0], fours[1], 4, 5, 6, 7, 12, 13, 14, 15);
  } else if constexpr (sizeof(V) == 4 * sizeof(F) &&
                       std::is_same_v<typename Short<F, 8>::Type, Halves>) {
    sums = {lane_sums(c[0], c[1], c[2], c[3]), lane_sums(c[4], c[5], c[6], c[7])};
  } else {
#pragma GCC unroll 8
    for (int j = 0; j < 8; ++j) {
      F sum = c[j][0];
      for (int i = 1; i < static_cast<int>(sizeof(V) / sizeof(F)); ++i) sum += c[j][i];
      set_number(sums, j, sum);
    }
  }
  return sums;
}

// Transposition of the columns of a panel, which lie in registers.

/// Rows of four columns of four numbers each, the first `count`, N numbers apart.
template <int N, typename F, typename V>
inline void store_four(const V& c0, const V& c1, const V& c2, const V& c3, int count, F* rows) {
  const V a0 = __builtin_shufflevector(c0, c1, 0, 4, 2, 6);
  const V a1 = __builtin_shufflevector(c0, c1, 1, 5, 3, 7);
  const V b0 = __builtin_shufflevector(c2, c3, 0, 4, 2, 6);
  const V b1 = __builtin_shufflevector(c2, c3, 1, 5, 3, 7);
  store<F, 4>(rows, __builtin_shufflevector(a0, b0, 0, 1, 4, 5));
  if (count > 1) store<F, 4>(rows + N, __builtin_shufflevector(a1, b1, 0, 1, 4, 5));
  if (count > 2) store<F, 4>(rows + 2 * N, __builtin_shufflevector(a0, b0, 2, 3, 6, 7));
  if (count > 3) store<F, 4>(rows + 3 * N, __builtin_shufflevector(a1, b1, 2, 3, 6, 7));
}

/// The first L rows of the P columns c, N numbers apart, padded with zeros.
template <typename F, int P, int L, int N, typename V>
inline void store_transposed(const V (&c)[P], F* rows) {
  constexpr int kLanes = sizeof(V) / sizeof(F);
  if constexpr (kLanes == 8 && P > 4 && !std::is_same_v<V, Halves>) {
    V a[8], b[8];
#pragma GCC unroll 4
    for (int i = 0; i < 8; i += 2) {
      const V one = i < P ? c[i < P ? i : 0] : V{},
              other = i + 1 < P ? c[i + 1 < P ? i + 1 : 0] : V{};
      a[i] = __builtin_shufflevector(one, other, 0, 8, 2, 10, 4, 12, 6, 14);
      a[i + 1] = __builtin_shufflevector(one, other, 1, 9, 3, 11, 5, 13, 7, 15);
    }
#pragma GCC unroll 2
    for (int i = 0; i < 8; i += 4) {
#pragma GCC unroll 2
      for (int k = 0; k < 2; ++k) {
        b[i + k] = __builtin_shufflevector(a[i + k], a[i + k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
        b[i + k + 2] = __builtin_shufflevector(a[i + k], a[i + k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
      }
    }
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
      const V low = __builtin_shufflevector(b[i], b[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
      const V high = __builtin_shufflevector(b[i], b[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
      store<F, 8>(rows + i * N, low);
      if (i + 4 < L) store<F, 8>(rows + (i + 4) * N, high);
    }
  } else if constexpr (kLanes >= 4 && P > 2) {
    using Four = typename Short<F, 4>::Type;
#pragma GCC unroll 2
    for (int from = 0; from < L; from += 4) {
#pragma GCC unroll 2
      for (int j = 0; j < P; j += 4) {
        Four part[4];
#pragma GCC unroll 4
        for (int k = 0; k < 4; ++k) {
          part[k] = Four{};
          if (j + k >= P) continue;
          const V& column = c[j + k < P ? j + k : 0];
          if constexpr (kLanes == 4) {
            part[k] = column;
          } else {
            part[k] = from == 0 ? four_of<0>(column) : four_of<4>(column);
          }
        }
        store_four<N>(part[0], part[1], part[2], part[3], L - from, rows + from * N + j);
      }
    }
  } else {
#pragma GCC unroll 8
    for (int i = 0; i < L; ++i) {
#pragma GCC unroll 8
      for (int j = 0; j < P; ++j) rows[i * N + j] = c[j][i];
    }
  }
}

}  // namespace mbs::compiled_ldl
