// Panels: elimination and substitution of a run, and which kernels it has. Part of panels.hpp.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "panels/block.hpp"
#include "panels/panels.hpp"

namespace mbs::compiled_ldl {

// Elimination of a run of panels.

template <typename F>
template <int P, int L, bool kDefinite>
bool Panels<F>::eliminate(const Run& run, F* y) {
  bool accepted = true;
  for (int i = run.begin; i < run.end; ++i) {
    if constexpr (P == 2) {
      accepted &= eliminate_pair<L, kDefinite>(panels_[i], y);
    } else if constexpr (P > 2 && kInScalars<F>) {
      accepted &= eliminate_in_scalars<P, L, kDefinite>(panels_[i], y);
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
    set_number(scale, j, inverse[j]);
    z += m[j] * y[panel.first + j];
  }
  store_transposed<F, P, P, N>(m, factors + P * N);
  store<F, N>(factors + 2 * P * N, scale);
  z *= scale;
  if constexpr (L == 0) {
    z = times_columns<F, P, N>(factors + P * N, z);  // nothing is left for backward()
  }
  store_first<P>(y + panel.first, z);
  if constexpr (L > 0) {
    subtract_below<P, L>(panel, z, y);
    update_border<P, L>(panel);
  }
  return accepted;
}

/// The same in scalars.
template <typename F>
template <int P, int L, bool kDefinite>
bool Panels<F>::eliminate_in_scalars(const Panel& panel, F* y) {
  constexpr int N = lanes_for(P);
  F* factors = factors_.data() + panel.factors;
  F l[P][P], inverse[P], z[P];
  const bool accepted = eliminate_triangle<kDefinite>(matrix() + panel.columns, panel.stride,
                                                      y + panel.first, l, inverse, z);
  unrolled<0, P>([&](auto j) { factors[2 * P * N + j] = inverse[j]; });
  if constexpr (L > 0) reduce_below<P, L>(panel, l, inverse);
  store_inverse<N>(l, factors, factors + P * N);
  if constexpr (L == 0) substitute_back(l, z);  // nothing is left for backward()
  store_first<P>(y + panel.first, vector_of<N>(z));
  if constexpr (L > 0) {
    subtract_below<P, L>(panel, z, y);
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

/// C becomes C L⁻ᵀ, and its rows times D⁻¹ are stored. `Column`: of L, a vector or numbers.
template <typename F>
template <int P, int kLanes, typename Column>
[[gnu::always_inline]] inline void Panels<F>::reduce_below(const Panel& panel,
                                                           const Column (&l)[P],
                                                           const F (&inverse)[P]) {
  constexpr int L = std::min(kLanes, kWidest<F>), N = lanes_for(P);
  using W = typename Short<F, L>::Type;
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
    if (kLanes <= 4 && kLanes <= L) break;
  }
}

// What an eliminated panel subtracts from the rows and columns after it.

/// y −= C z at the rows below.
template <typename F>
template <int P, int L, typename Z>
[[gnu::always_inline]] inline void Panels<F>::subtract_below(const Panel& panel, const Z& z,
                                                             F* y) const {
  using W = typename Short<F, L>::Type;
  constexpr bool kApart = kInScalars<F> && P > 3;  // two sums that do not wait for each other
  const F* below = matrix_.data() + kMargin + panel.columns + P;
  const int* rows = program_.border_rows.data() + panel.rows;
  for (int i = 0; i < panel.below; i += L) {
    const int count = std::min(L, panel.below - i);
    W sum = load<F, L>(below + i) * z[0], other = {};
#pragma GCC unroll 8
    for (int j = 1; j < P; ++j) {
      const W product = load<F, L>(below + j * panel.stride + i) * z[j];
      if (!kApart || j % 2 == 0) {
        sum += product;
      } else {
        other = j == 1 ? product : other + product;
      }
    }
    if (kApart) sum += other;
    if (L > 4 && i + count <= panel.following) {
      store<F, L>(y + rows[i], load<F, L>(y + rows[i]) - first_lanes<F, L>(sum, count));
    } else {
      alignas(sizeof(W)) F numbers[L];
      store<F, L>(numbers, sum);
      for (int l = 0; l < count; ++l) y[rows[i + l]] -= numbers[l];
    }
    if (L <= 4) break;  // which all of the border is
  }
}

/// Columns from `target` on lose C D⁻¹ Cᵀ in `rows` rows, at most L, which lie at `below` in C and
/// at `target` in the first column. The rows of W of these columns begin at g.
template <typename F>
template <int P, int L>
void Panels<F>::update_rows(const F* below, int stride, int rows, const F* g, int columns,
                            F* target, int target_stride) {
  using W = typename Short<F, L>::Type;
  constexpr int N = lanes_for(P);
  W c[P];
#pragma GCC unroll 8
  for (int j = 0; j < P; ++j) c[j] = first_lanes<F, L>(load<F, L>(below + j * stride), rows);
  for (int k = 0; k < columns; ++k) {
    W s = load<F, L>(target);
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) s -= c[j] * g[j];
    store<F, L>(target, s);
    g += N;
    target += target_stride;
  }
}

template <typename F>
template <int P, int L>
[[gnu::always_inline]] inline void Panels<F>::update_border(const Panel& panel) {
  if (L == 2 && panel.is_two) return update_two<P>(panel);
  const F* below = matrix() + panel.columns + P;
  const F* g = factors_.data() + panel.factors + (2 * P + 1) * lanes_for(P);
  for (int i = panel.strips_begin; i < panel.strips_end; ++i) {
    const Strip& s = strips_[i];
    const F* from = below + s.begin;
    const F* of_columns = g + s.column * lanes_for(P);
    F* target = matrix() + s.target;
    if (L > 4 && s.rows > 4) {
      update_rows<P, std::min(L, kWidest<F>)>(from, panel.stride, s.rows, of_columns, s.columns,
                                              target, s.stride);
    } else if (L > 2 && s.rows > 2) {
      update_rows<P, std::min(L, 4)>(from, panel.stride, s.rows, of_columns, s.columns, target,
                                     s.stride);
    } else {
      update_rows<P, 2>(from, panel.stride, s.rows, of_columns, s.columns, target, s.stride);
    }
  }
}

/// The update of two border rows that are neighbours, in scalars.
template <typename F>
template <int P>
void Panels<F>::update_two(const Panel& panel) {
  constexpr int N = lanes_for(P);
  const F* below = matrix() + panel.columns + P;
  const F* g = factors_.data() + panel.factors + (2 * P + 1) * N;
  F s00 = below[0] * g[0], s10 = below[1] * g[0], s11 = below[1] * g[N];
#pragma GCC unroll 8
  for (int j = 1; j < P; ++j) {
    const F* c = below + j * panel.stride;
    s00 += c[0] * g[j];
    s10 += c[1] * g[j];
    s11 += c[1] * g[N + j];
  }
  const Strip& strip = strips_[panel.strips_begin];
  F* target = matrix() + strip.target;
  target[0] -= s00;
  target[1] -= s10;
  target[strip.stride + 1] -= s11;
}

// Substitution with the factors there are.

/// z = D⁻¹ M y in place of the pivots' y; y −= C L⁻ᵀ z below.
template <typename F>
template <int P, int L>
void Panels<F>::forward(const Run& run, F* y) {
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
      z = times_lower<F, P, N>(factors, x);
      z *= load<F, N>(factors + 2 * P * N);
      if constexpr (L == 0) z = times_upper<F, P, N>(factors + P * N, z);
      store_first<P>(x, z);
    }
    if constexpr (L > 0) subtract_below<P, L>(panel, z, y);
  }
}

/// x = Mᵀ (z − Wᵀ x below).
template <typename F>
template <int P, int L>
void Panels<F>::backward(const Run& run, F* y) {
  constexpr int N = lanes_for(P);
  using V = typename Short<F, N>::Type;
  if constexpr (L == 0) return;
  for (int i = run.end - 1; i >= run.begin; --i) {
    const Panel& panel = panels_[i];
    const F* factors = factors_.data() + panel.factors;
    const F* transposed = factors + P * N;
    const F* g = transposed + (P + 1) * N;
    const int* rows = program_.border_rows.data() + panel.rows;
    V x0 = load_first<P, N>(y + panel.first), x1 = V{}, x2 = V{}, x3 = V{};
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
      store_first<P>(y + panel.first, times_upper<F, P, N>(transposed, x0));
    }
  }
}

// Which of these a run has.

template <typename F>
template <int P>
void Panels<F>::choose_kernels(Run& run, const FrontShape& shape) const {
  if (shape.wide) return set_wide_kernels<P>(run);
  switch (shape.lanes) {
    case 0:
      set_kernels<P, 0>(run);
      break;
    case 2:
      set_kernels<P, 2>(run);
      break;
    case 4:
      set_kernels<P, 4>(run);
      break;
    case 8:
      set_kernels<P, 8>(run);
      break;
    default:
      throw std::logic_error("no kernel takes so many rows at a time");
  }
}

template <typename F>
template <int P, int L>
void Panels<F>::set_kernels(Run& run) const {
  run.eliminate = definite_ ? &Panels::template eliminate<P, L, true>
                            : &Panels::template eliminate<P, L, false>;
  run.forward = &Panels::template forward<P, L>;
  run.backward = &Panels::template backward<P, L>;
}

}  // namespace mbs::compiled_ldl
