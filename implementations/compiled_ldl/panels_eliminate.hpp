// Panels<F>: elimination of a run of panels. Part of panels.hpp.
#pragma once

#include "panels.hpp"

namespace mbs::compiled_ldl {

template <typename F>
bool Panels<F>::factorize_and_solve(F* y) {
  bool accepted = true;
  for (const Run& run : runs_) accepted &= (this->*run.eliminate)(run, y);
  for (auto run = runs_.rbegin(); run != runs_.rend(); ++run) (this->*run->backward)(*run, y);
  return accepted;
}

template <typename F>
template <int P, int L, bool kDefinite>
bool Panels<F>::eliminate(const Run& run, F* y) {
  bool accepted = true;
  for (int i = run.begin; i < run.end; ++i) {
    if constexpr (P == 2) {
      accepted &= eliminate_pair<L, kDefinite>(panels_[i], y);
    } else {
      accepted &= eliminate_panel<P, L, kDefinite>(panels_[i], y);
    }
  }
  return accepted;
}

template <typename F>
template <int P, int L, bool kDefinite>
bool Panels<F>::eliminate_panel(const Panel& panel, F* y) {
  constexpr int N = lanes_for(P);
  using V = typename Short<F, N>::Type;
  const F* columns = matrix() + panel.columns;
  F* factors = factors_.data() + panel.factors;
  V a[P], l[P], m[P];
  F inverse[P];
#pragma GCC unroll 8
  for (int j = 0; j < P; ++j) a[j] = load<F, N>(columns + j * panel.stride);
  const bool accepted = decompose<F, P, kDefinite>(a, l, inverse);
  if constexpr (L > 0) reduce_below<P, L>(panel, l, inverse);
  invert_triangle<F, P>(l, m);
  V scale = V{}, z = V{};
#pragma GCC unroll 8
  for (int j = 0; j < P; ++j) {
    store<F, N>(factors + j * N, m[j]);
    scale[j] = inverse[j];
    z += m[j] * y[panel.first + j];
  }
  store_transposed<F, P, P, N>(m, factors + P * N);
  store<F, N>(factors + 2 * P * N, scale);
  z *= scale;
  if constexpr (L == 0) {
    z = times_transposed<P>(factors + P * N, z);  // nothing is left for backward()
  }
  store_first<P>(y + panel.first, z);
  if constexpr (L > 0) {
    subtract_below<P, L>(panel, z, y);
    if constexpr (L == 8) {
      if (panel.inside > 0) update_inside<P>(panel);
    }
    update_border<P, L>(panel);
  }
  return accepted;
}

/// The same for two pivots, in scalars: a vector's load would wait for the element's narrow stores.
/// Of the factors only l, in its place in M, and D⁻¹ are kept.
template <typename F>
template <int L, bool kDefinite>
bool Panels<F>::eliminate_pair(const Panel& panel, F* y) {
  using V = typename Short<F, 2>::Type;
  const F* columns = matrix() + panel.columns;
  F* factors = factors_.data() + panel.factors;
  const F x = columns[0], c = columns[1], w = columns[panel.stride + 1];
  const F of_pair = F(1) / determinant(x, c, w);
  const F inverse[2] = {F(1) / x, x * of_pair};
  const F l = c * inverse[0];
  bool accepted = inverse[0] - inverse[0] == F(0) && of_pair - of_pair == F(0);
  accepted &= kDefinite ? x > F(0) && of_pair > F(0) : inverse[1] != F(0);
  factors[1] = l;
  factors[8] = inverse[0];
  factors[9] = inverse[1];
  const V columns_of_l[2] = {V{F(1), l}, V{F(0), F(1)}};
  if constexpr (L > 0) reduce_below<2, L>(panel, columns_of_l, inverse);
  F* b = y + panel.first;
  const V z = {b[0] * inverse[0], (b[1] - l * b[0]) * inverse[1]};
  b[0] = L > 0 ? z[0] : z[0] - l * z[1];
  b[1] = z[1];
  if constexpr (L > 0) {
    subtract_below<2, L>(panel, z, y);
    update_border<2, L>(panel);
  }
  return accepted;
}

/// C becomes C L⁻ᵀ, and its rows times D⁻¹ are stored.
template <typename F>
template <int P, int L>
void Panels<F>::reduce_below(const Panel& panel,
                             const typename Short<F, lanes_for(P)>::Type (&l)[P],
                             const F (&inverse)[P]) {
  using W = typename Short<F, L>::Type;
  constexpr int N = lanes_for(P);
  F* below = matrix() + panel.columns + P;
  F* rows = factors_.data() + panel.factors + (2 * P + 1) * N;
  for (int i = 0; i < panel.below; i += L) {
    W c[P];
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) {
      c[j] = load<F, L>(below + j * panel.stride + i);
#pragma GCC unroll 8
      for (int k = 0; k < j; ++k) c[j] -= c[k] * l[k][j];
      if (j > 0) store<F, L>(below + j * panel.stride + i, c[j]);
    }
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) c[j] *= inverse[j];
    store_transposed<F, P, L, N>(c, rows + i * N);
  }
}

}  // namespace mbs::compiled_ldl
