// Transposition of the columns of a panel, which lie in registers.
#pragma once

#include "panel_vectors.hpp"

namespace mbs::compiled_ldl {

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
  if constexpr (kLanes == 8 && P > 4) {
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
            part[k] = from == 0 ? __builtin_shufflevector(column, column, 0, 1, 2, 3)
                                : __builtin_shufflevector(column, column, 4, 5, 6, 7);
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
