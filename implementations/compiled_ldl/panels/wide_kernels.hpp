// Wide fronts: elimination and substitution, and the kernels of a run. Part of panels.hpp.
#pragma once

#include <algorithm>

#include "panels/block.hpp"
#include "panels/panels.hpp"

namespace mbs::compiled_ldl {

// Right-hand sides. What lies behind a front's rows in y is left as it is.

/// That of the front's pivots, behind it zeros from a multiple of eight on; y itself if there is no
/// border.
template <typename F>
F* WideFronts<F>::take_right(const Wide& front, F* y) {
  y += front.first;
  if (front.border == 0) return y;
  F* right = right_.data();
  const int padded = front.panels * kPanel;
  for (int i = 0; i < padded; i += L) {
    store<F, L>(right + i, first_lanes<F, L>(load<F, L>(y + i), front.pivots - i));
  }
  for (int i = 0; i < front.length; i += L) store<F, L>(right + padded + i, W{});
  return right;
}

template <typename F>
void WideFronts<F>::give_right(const Wide& front, F* y) const {
  if (front.border == 0) return;
  y += front.first;
  for (int i = 0; i < front.pivots; i += L) {
    store<F, L>(y + i, first_lanes_or<F, L>(load<F, L>(right_.data() + i), load<F, L>(y + i),
                                            front.pivots - i));
  }
}

/// P numbers of the pivots.
template <typename F>
template <int P>
void WideFronts<F>::store_pivots(F* right, const Eight& x) {
  store<F, kPanel>(right, first_lanes_or<F, kPanel>(x, load<F, kPanel>(right), P));
}

template <typename F>
void WideFronts<F>::add_border(const Wide& front, F* y) const {
  const int* rows = program_.border_rows.data() + front.rows;
  const F* right = right_.data() + front.panels * kPanel;
  for (int i = 0; i < front.border; ++i) y[rows[i]] += right[i];
}

// Elimination from the left.

template <typename F>
template <int P, bool kDefinite>
bool WideFronts<F>::eliminate(int k, F* matrix, F* y) {
  const Wide& front = fronts_[k];
  F* right = take_right(front, y);
  bool accepted = true;
  const int last = front.panels - 1;
  for (int i = 0; i < last; ++i) {
    accepted &= eliminate_panel<kPanel, kDefinite>(front, matrix + front.base, i, right);
  }
  accepted &= eliminate_panel<P, kDefinite>(front, matrix + front.base, last, right);
  give_right(front, y);
  if (front.border == 0) return accepted;
  add_border(front, y);
  update_border(front, matrix);
  return accepted;
}

/// scaled_ = D⁻¹ C of so many of eight rows, in the first so many columns.
template <typename F>
template <int kRows>
void WideFronts<F>::scale_rows(const Wide& front, const F* rows, int stride, int columns) {
  const F* inverse = factors_.data() + front.inverses;
  F* scaled = scaled_.data();
  for (int j = 0; j < columns; ++j) {
#pragma GCC unroll 4
    for (int i = 0; i < kRows; i += L) {
      store<F, L>(scaled + j * kPanel + i, load<F, L>(rows + j * stride + i) * inverse[j]);
    }
  }
}

/// s −= C D⁻¹ Cᵀ of the first so many columns: C of R vectors of rows, D⁻¹ Cᵀ of the columns kFrom
/// … kTo − 1.
template <typename F>
template <int kFrom, int kTo, int P, int R>
[[gnu::always_inline]] inline void WideFronts<F>::take_up(F* const (&rows)[R], int stride,
                                                          const F* scaled, int columns,
                                                          W (&s)[P][R]) {
  for (int j = 0; j < columns; ++j, scaled += kPanel) {
    W c[R];
#pragma GCC unroll 3
    for (int r = 0; r < R; ++r) {
      c[r] = load<F, L>(rows[r] + j * stride);
      hold(c[r]);
    }
#pragma GCC unroll 8
    for (int k = kFrom; k < kTo; ++k) {
      const F of_column = scaled[k];
#pragma GCC unroll 3
      for (int r = 0; r < R; ++r) s[k][r] -= c[r] * of_column;
    }
  }
}

/// The columns of a block of pivots become L, M, Mᵀ and D⁻¹; z_of becomes D⁻¹ M z_of.
template <typename F>
template <int P, bool kDefinite>
[[gnu::always_inline]] inline bool WideFronts<F>::eliminate_block(const F* block, F* factors,
                                                                  F* inverses,
                                                                  F (&lower)[P][kPanel], F* z_of) {
  Eight a[P], l[P], m[P];
  F inverse[P];
#pragma GCC unroll 8
  for (int j = 0; j < P; ++j) a[j] = load<F, kPanel>(block + j * kPanel);
  const bool accepted = decompose<F, P, kDefinite>(a, l, inverse);
  invert_triangle<F, P>(l, m);
  Eight scale = Eight{}, z = Eight{};
#pragma GCC unroll 8
  for (int j = 0; j < P; ++j) {
    store<F, kPanel>(lower[j], l[j]);
    store<F, kPanel>(factors + j * kPanel, m[j]);
    set_number(scale, j, inverse[j]);
    z += m[j] * z_of[j];
  }
  store_transposed<F, P, P, kPanel>(m, factors + kBlock);
  store<F, kPanel>(inverses, scale);
  store_pivots<P>(z_of, z * scale);
  return accepted;
}

template <typename F>
template <int P, bool kDefinite>
bool WideFronts<F>::eliminate_panel(const Wide& front, const F* matrix, int k, F* right) {
  const int from = k * kPanel;
  const F* target = matrix + from * front.stride;
  F* factors = factors_of(front, k);
  F* z_of = right + from;
  Rows rows = pivot_rows(front, k);
  alignas(64) F block[P * kPanel], l[P][kPanel];
  // Of many panels the time is in what is below the blocks, and scalars are no gain.
  const bool in_scalars = kInScalars<F> && front.panels <= 2;
  if (from > 0 || !in_scalars) {
    scale_rows<kPanel>(front, rows.at, rows.stride, from);
#pragma GCC unroll 4
    for (int i = 0; i < kPanel; i += L) {
      W s[P][1];
#pragma GCC unroll 8
      for (int j = 0; j < P; ++j) s[j][0] = load<F, L>(target + j * front.stride + from + i);
      take_up<0, P, P, 1>({rows.at + i}, rows.stride, scaled_.data(), from, s);
#pragma GCC unroll 8
      for (int j = 0; j < P; ++j) store<F, L>(block + j * kPanel + i, s[j][0]);
    }
  }
  bool accepted = true;
  if (in_scalars) {
    if constexpr (kInScalars<F>) {
      F inverse[P], z[P];
      accepted = eliminate_triangle<kDefinite>(
          from > 0 ? block : target, from > 0 ? kPanel : front.stride, z_of, l, inverse, z);
      store_pivots<P>(z_of, vector_of<kPanel>(z));
      store_inverse<kPanel>(l, factors, factors + kBlock);
      for (int j = 0; j < P; ++j) factors_[front.inverses + from + j] = inverse[j];
    }
  } else {
    accepted = eliminate_block<P, kDefinite>(block, factors,
                                             factors_.data() + front.inverses + from, l, z_of);
  }
  if constexpr (P == kPanel) {
    const int count = (front.pivots - from - kPanel + L - 1) / L;
    const auto vector = [&](int i) {
      const int row = from + kPanel + i * L;
      return pivot_rows(front, row / kPanel).at + row % kPanel;
    };
    finish_all<P>(front.stride, target + from + kPanel, vector, kPanel, count, from, l[0], z_of,
                  z_of + kPanel);
  }
  rows = border_rows(front);
  const auto vector = [&](int i) { return rows.at + i * L; };
  finish_all<P>(front.stride, target + front.pivots, vector, rows.stride,
                (front.border + L - 1) / L, from, l[0], z_of, right + front.panels * kPanel);
  return accepted;
}

/// So many vectors of rows below the panel's block, of which `l` has L and `z` the solution.
/// `target`: the matrix in the panel's first column; `right`: the right-hand side.
template <typename F>
template <int P, typename Vector>
[[gnu::always_inline]] inline void WideFronts<F>::finish_all(int stride, const F* target,
                                                             const Vector& vector, int rows_stride,
                                                             int count, int from, const F* l,
                                                             const F* z, F* right) {
  int i = 0;
  for (; i + kVectors <= count; i += kVectors) {
    F* rows[kVectors];
    for (int r = 0; r < kVectors; ++r) rows[r] = vector(i + r);
    finish_rows<P, kVectors>(stride, target + i * L, rows, rows_stride, from, l, z, right + i * L);
  }
  for (; i < count; ++i) {
    finish_rows<P, 1>(stride, target + i * L, {vector(i)}, rows_stride, from, l, z, right + i * L);
  }
}

template <typename F>
template <int P, int R>
void WideFronts<F>::finish_rows(int stride, const F* target, F* const (&rows)[R], int rows_stride,
                                int from, const F* l, const F* z, F* right) {
  W s[P][R];
#pragma GCC unroll 8
  for (int k = 0; k < P; ++k) {
#pragma GCC unroll 3
    for (int r = 0; r < R; ++r) s[k][r] = load<F, L>(target + k * stride + r * L);
  }
  constexpr int kHalf = R == 1 ? P : std::min(P, kColumns);
  take_up<0, kHalf, P, R>(rows, rows_stride, scaled_.data(), from, s);
  if constexpr (kHalf < P) take_up<kHalf, P, P, R>(rows, rows_stride, scaled_.data(), from, s);
  W y[R];
#pragma GCC unroll 3
  for (int r = 0; r < R; ++r) y[r] = load<F, L>(right + r * L);
#pragma GCC unroll 8
  for (int k = 0; k < P; ++k) {
#pragma GCC unroll 8
    for (int j = 0; j < k; ++j) {
      const F l_kj = l[j * kPanel + k];
#pragma GCC unroll 3
      for (int r = 0; r < R; ++r) s[k][r] -= s[j][r] * l_kj;
    }
    const F z_k = z[k];
#pragma GCC unroll 3
    for (int r = 0; r < R; ++r) {
      y[r] -= s[k][r] * z_k;
      store<F, L>(rows[r] + (from + k) * rows_stride, s[k][r]);
    }
  }
#pragma GCC unroll 3
  for (int r = 0; r < R; ++r) store<F, L>(right + r * L, y[r]);
}

// What the border subtracts from other fronts, for all panels in one go.

template <typename F>
void WideFronts<F>::update_border(const Wide& front, F* matrix) {
  const Rows rows = border_rows(front);
  for (int begin = front.strips_begin, end; begin < front.strips_end; begin = end) {
    const int first = strips_[begin].column;
    for (end = begin; end < front.strips_end && strips_[end].column == first;) ++end;
    for (int k = 0; k < strips_[end - 1].columns; k += kPanel) {
      scale_rows<kPanel>(front, rows.at + first + k, rows.stride, front.pivots);
      for (int i = begin; i < end; ++i) update_columns<kPanel>(front, matrix, strips_[i], k);
    }
  }
}

/// The columns of a strip from `column` on, at most K. scaled_ has their rows.
template <typename F>
template <int K>
void WideFronts<F>::update_columns(const Wide& front, F* matrix, const Strip& strip, int column) {
  if (strip.columns - column < K) {
    if constexpr (K > 1) update_columns<K - 1>(front, matrix, strip, column);
    return;
  }
  constexpr int N = std::max(4, L);  // a strip may have four rows
  using V = typename Short<F, N>::Type;
  F* target = matrix + strip.target + column * strip.stride;
  const F* rows = border_rows(front).at + strip.begin;
  const F* scaled = scaled_.data();
  V s[K];
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k) s[k] = load<F, N>(target + k * strip.stride);
  for (int j = 0; j < front.pivots; ++j, rows += front.length, scaled += kPanel) {
    const V c = first_lanes<F, N>(load<F, N>(rows), strip.rows);
#pragma GCC unroll 8
    for (int k = 0; k < K; ++k) s[k] -= c * scaled[k];
  }
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k) store<F, N>(target + k * strip.stride, s[k]);
}

// Substitution with the factors there are.

template <typename F>
template <int P>
void WideFronts<F>::forward(int k, F* y) {
  const Wide& front = fronts_[k];
  F* right = take_right(front, y);
  const int last = front.panels - 1;
  for (int i = 0; i < last; ++i) forward_panel<kPanel>(front, i, right);
  forward_panel<P>(front, last, right);
  give_right(front, y);
  add_border(front, y);
}

/// z = D⁻¹ M y in place of the pivots' y; y −= C L⁻ᵀ z below.
template <typename F>
template <int P>
void WideFronts<F>::forward_panel(const Wide& front, int k, F* right) {
  const int from = k * kPanel;
  Eight z = times_lower<F, P, kPanel>(factors_of(front, k), right + from);
  z *= load<F, kPanel>(factors_.data() + front.inverses + from);
  store_pivots<P>(right + from, z);
  const auto subtract = [&](Rows rows, F* y) {
    const F* columns = rows.at + from * rows.stride;
    W even = load<F, L>(y), odd = W{};
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) {
      W& sum = j % 2 == 0 ? even : odd;
      sum -= load<F, L>(columns + j * rows.stride) * z[j];
    }
    store<F, L>(y, even + odd);
  };
  for (int b = k + 1; P == kPanel && b < front.panels; ++b) {
    Rows rows = pivot_rows(front, b);
#pragma GCC unroll 4
    for (int i = 0; i < kPanel; i += L, rows.at += L) subtract(rows, right + b * kPanel + i);
  }
  Rows rows = border_rows(front);
  right += front.panels * kPanel;
  for (int i = 0; i < front.border; i += L, rows.at += L) subtract(rows, right + i);
}

template <typename F>
template <int P>
void WideFronts<F>::backward(int k, F* y) {
  const Wide& front = fronts_[k];
  F* right = take_right(front, y);
  const int* rows = program_.border_rows.data() + front.rows;
  for (int i = 0; i < front.border; ++i) right[front.panels * kPanel + i] = y[rows[i]];
  backward_panel<P>(front, front.panels - 1, right);
  for (int i = front.panels - 2; i >= 0; --i) backward_panel<kPanel>(front, i, right);
  give_right(front, y);
}

/// x = Mᵀ (z − D⁻¹ (C L⁻ᵀ)ᵀ x below).
template <typename F>
template <int P>
void WideFronts<F>::backward_panel(const Wide& front, int k, F* right) {
  const int from = k * kPanel;
  W sums[kPanel] = {};
  const auto add = [&](Rows rows, const F* x) {
    const F* columns = rows.at + from * rows.stride;
    const W x_i = load<F, L>(x);
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) sums[j] += load<F, L>(columns + j * rows.stride) * x_i;
  };
  Rows rows = border_rows(front);
  for (int i = 0; i < front.border; i += L, rows.at += L) {
    add(rows, right + front.panels * kPanel + i);
  }
  for (int b = front.panels - 1; P == kPanel && b > k; --b) {  // the newest part of x comes last
    rows = pivot_rows(front, b);
#pragma GCC unroll 4
    for (int i = 0; i < kPanel; i += L, rows.at += L) add(rows, right + b * kPanel + i);
  }
  const Eight z = load<F, kPanel>(right + from) -
                  load<F, kPanel>(factors_.data() + front.inverses + from) * lane_sums<F>(sums);
  store_pivots<P>(right + from, times_upper<F, P, kPanel>(factors_of(front, k) + kBlock, z));
}

// Runs of wide fronts.

template <typename F>
template <int P, bool kDefinite>
bool Panels<F>::eliminate_wide(const Run& run, F* y) {
  bool accepted = true;
  for (int i = run.begin; i < run.end; ++i) {
    accepted &= wide_.template eliminate<P, kDefinite>(i, matrix(), y);
  }
  return accepted;
}

template <typename F>
template <int P>
void Panels<F>::forward_wide(const Run& run, F* y) {
  for (int i = run.begin; i < run.end; ++i) wide_.template forward<P>(i, y);
}

template <typename F>
template <int P>
void Panels<F>::backward_wide(const Run& run, F* y) {
  for (int i = run.end - 1; i >= run.begin; --i) wide_.template backward<P>(i, y);
}

template <typename F>
template <int P>
void Panels<F>::set_wide_kernels(Run& run) const {
  run.eliminate = definite_ ? &Panels::template eliminate_wide<P, true>
                            : &Panels::template eliminate_wide<P, false>;
  run.forward = &Panels::template forward_wide<P>;
  run.backward = &Panels::template backward_wide<P>;
}

}  // namespace mbs::compiled_ldl
