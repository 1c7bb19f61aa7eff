// Product with a symmetric matrix of which the lower half is stored.
#pragma once

#include "panels/vectors.hpp"

namespace mbs::compiled_ldl {

/// y += s A x. Columns lie `stride` apart and are zero below the last row, up to a multiple of
/// eight rows. Eight columns at a time are read once for what they add below and, transposed, to
/// their own rows. A = [2 1; 1 3] is (2 1) and (· 3). With s = 1 and x = (1 2) its first column
/// adds 2 · 1 and 1 · 2 to y_0 and 1 · 1 to y_1, its second one 3 · 2 to y_1: (4 7).
template <typename F>
void add_symmetric_product(const F* a, int stride, int size, F s, const F* x, F* y) {
  constexpr int L = kWidest<F>, N = 8;
  using W = typename Short<F, L>::Type;
  int from = 0;
  for (; from + N <= size; from += N, a += N * stride) {
    F factor[N];
    W sums[N] = {};
#pragma GCC unroll 8
    for (int j = 0; j < N; ++j) factor[j] = s * x[from + j];
#pragma GCC unroll 4
    for (int i = 0; i < N; i += L) {  // on the diagonal
      const W x_i = load<F, L>(x + from + i);
      W y_i = load<F, L>(y + from + i);
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j) {
        const W column = load<F, L>(a + j * stride + from + i);
        y_i += first_lanes_or<F, L>(W{}, column, j - i) * factor[j];
        sums[j] += first_lanes_or<F, L>(W{}, column, j + 1 - i) * x_i;
      }
      store<F, L>(y + from + i, y_i);
    }
    for (int i = from + N; i < size; i += L) {
      const W x_i = load<F, L>(x + i);
      W y_i = load<F, L>(y + i);
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j) {
        const W column = load<F, L>(a + j * stride + i);
        y_i += column * factor[j];
        sums[j] += column * x_i;
      }
      store<F, L>(y + i, y_i);
    }
    store<F, N>(y + from, load<F, N>(y + from) + lane_sums<F>(sums) * s);
  }
  for (int j = from; j < size; ++j, a += stride) {
    y[j] += s * a[j] * x[j];
    for (int i = j + 1; i < size; ++i) {
      y[i] += s * a[i] * x[j];
      y[j] += s * a[i] * x[i];
    }
  }
}

}  // namespace mbs::compiled_ldl
