// Panels<F>: substitution with the factors there are. Part of panels.hpp.
#pragma once

#include "panels.hpp"

namespace mbs::compiled_ldl {

template <typename F>
void Panels<F>::solve(F* y) const {
  for (const Run& run : runs_) (this->*run.forward)(run, y);
  for (auto run = runs_.rbegin(); run != runs_.rend(); ++run) (this->*run->backward)(*run, y);
}

/// z = D⁻¹ M y in place of the pivots' y; y −= C L⁻ᵀ z below.
template <typename F>
template <int P, int L>
void Panels<F>::forward(const Run& run, F* y) const {
  constexpr int N = lanes_for(P);
  using V = typename Short<F, N>::Type;
  for (int i = run.begin; i < run.end; ++i) {
    const Panel& panel = panels_[i];
    const F* factors = factors_.data() + panel.factors;
    F* x = y + panel.first;
    V z;
    if constexpr (P == 2) {
      z = V{x[0] * factors[8], (x[1] - factors[1] * x[0]) * factors[9]};
      x[0] = L > 0 ? z[0] : z[0] - factors[1] * z[1];
      x[1] = z[1];
    } else {
      z = load<F, N>(factors) * x[0];
#pragma GCC unroll 8
      for (int j = 1; j < P; ++j) z += load<F, N>(factors + j * N) * x[j];
      z *= load<F, N>(factors + 2 * P * N);
      if constexpr (L == 0) z = times_transposed<P>(factors + P * N, z);
      store_first<P>(x, z);
    }
    if constexpr (L > 0) subtract_below<P, L>(panel, z, y);
  }
}

template <typename F>
template <int P>
typename Short<F, lanes_for(P)>::Type Panels<F>::times_transposed(
    const F* columns, const typename Short<F, lanes_for(P)>::Type& z) {
  constexpr int N = lanes_for(P);
  using V = typename Short<F, N>::Type;
  V even = load<F, N>(columns) * z[0], odd = V{};
#pragma GCC unroll 8
  for (int j = 1; j < P; ++j) {
    if (j % 2 == 0) {
      even += load<F, N>(columns + j * N) * z[j];
    } else {
      odd += load<F, N>(columns + j * N) * z[j];
    }
  }
  return even + odd;
}

/// x = Mᵀ (z − Wᵀ x below).
template <typename F>
template <int P, int L>
void Panels<F>::backward(const Run& run, F* y) const {
  constexpr int N = lanes_for(P);
  using V = typename Short<F, N>::Type;
  if constexpr (L == 0) return;
  for (int i = run.end - 1; i >= run.begin; --i) {
    const Panel& panel = panels_[i];
    const F* transposed = factors_.data() + panel.factors + P * N;
    const F* g = transposed + (P + 1) * N;
    const int* rows = rows_.data() + panel.rows;
    V x0 = load<F, N>(y + panel.first), x1 = V{}, x2 = V{}, x3 = V{};
    int k = 0;
    for (; k + 4 <= panel.below; k += 4) {
      x0 -= load<F, N>(g + k * N) * y[rows[k]];
      x1 -= load<F, N>(g + k * N + N) * y[rows[k + 1]];
      x2 -= load<F, N>(g + k * N + 2 * N) * y[rows[k + 2]];
      x3 -= load<F, N>(g + k * N + 3 * N) * y[rows[k + 3]];
    }
    for (; k < panel.below; ++k) x0 -= load<F, N>(g + k * N) * y[rows[k]];
    x0 = (x0 + x1) + (x2 + x3);
    if constexpr (P == 2) {
      y[panel.first] = x0[0] - transposed[1 - P * N] * x0[1];
      y[panel.first + 1] = x0[1];
    } else {
      store_first<P>(y + panel.first, times_transposed<P>(transposed, x0));
    }
  }
}

}  // namespace mbs::compiled_ldl
