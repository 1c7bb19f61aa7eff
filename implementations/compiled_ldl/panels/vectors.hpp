// Short vectors of a panel's width: loads, stores of a part, sums over lanes, transposition.
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

/// Has a vector in its register from here on: compilers load it again for every product otherwise.
template <typename V>
[[gnu::always_inline]] inline void hold([[maybe_unused]] V& x) {
#ifdef __x86_64__
  asm("" : "+v"(x));
#endif
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
