// Panels<F>: what an eliminated panel subtracts from the rows and columns after it. Part of
// panels.hpp.
#pragma once

#include "panels.hpp"

namespace mbs::compiled_ldl {

/// y −= C z at the rows below.
template <typename F>
template <int P, int L>
void Panels<F>::subtract_below(const Panel& panel, const typename Short<F, lanes_for(P)>::Type& z,
                               F* y) const {
  using W = typename Short<F, L>::Type;
  const F* below = matrix_.data() + kMargin + panel.columns + P;
  const int* rows = rows_.data() + panel.rows;
  for (int i = 0; i < panel.below; i += L) {
    W sum = load<F, L>(below + i) * z[0];
#pragma GCC unroll 8
    for (int j = 1; j < P; ++j) sum += load<F, L>(below + j * panel.stride + i) * z[j];
    if (L > 4 && panel.contiguous) {
      store<F, L>(y + rows[i], load<F, L>(y + rows[i]) - sum);
    } else {
      const int count = std::min(L, panel.below - i);
      for (int l = 0; l < count; ++l) y[rows[i + l]] -= sum[l];
    }
  }
}

/// Further columns of the front, two at a time.
template <typename F>
template <int P>
void Panels<F>::update_inside(const Panel& panel) {
  using W = typename Short<F, 8>::Type;
  constexpr int N = lanes_for(P);
  const F* below = matrix() + panel.columns + P;
  const F* g = factors_.data() + panel.factors + (2 * P + 1) * N;
  for (int k = 0; k < panel.inside; k += 2) {
    const bool both = k + 1 < panel.inside;
    F* one = matrix() + panel.columns + (P + k) * panel.stride + P;
    F* other = both ? one + panel.stride : work_.data();
    const F* g0 = g + k * N;
    const F* g1 = both ? g0 + N : g0;
    for (int i = k / 8 * 8; i < panel.below; i += 8) {
      W s0 = load<F, 8>(one + i), s1 = load<F, 8>(other + i);
#pragma GCC unroll 8
      for (int j = 0; j < P; ++j) {
        const W c = load<F, 8>(below + j * panel.stride + i);
        s0 -= c * g0[j];
        s1 -= c * g1[j];
      }
      store<F, 8>(one + i, s0);
      store<F, 8>(other + i, s1);
    }
  }
}

template <typename F>
template <int P, int L>
void Panels<F>::update_border(const Panel& panel) {
  for (int g = panel.groups_begin; g < panel.groups_end; ++g) {
    const Group& group = program_.groups[g];
    if (L == 2 && group.end == 2 && group.begin == 0) {
      update_two<P>(panel, group);
      continue;
    }
    for (int k = group.begin; k < group.end; ++k) update_column<P, L>(panel, group, k);
  }
}

/// The update of two border rows that are neighbours, in scalars.
template <typename F>
template <int P>
void Panels<F>::update_two(const Panel& panel, const Group& group) {
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
  const int* places = program_.positions.data() + group.positions;
  F* target = matrix() + group.base;
  target[places[0]] -= s00;
  target[places[1]] -= s10;
  target[group.stride + places[1]] -= s11;
}

/// Border column k of the update, added to the column that it goes to.
template <typename F>
template <int P, int L>
void Panels<F>::update_column(const Panel& panel, const Group& group, int k) {
  using W = typename Short<F, L>::Type;
  constexpr int N = lanes_for(P);
  const int at = panel.inside + k;  // among the rows below
  const F* below = matrix() + panel.columns + P;
  const F* g = factors_.data() + panel.factors + (2 * P + 1 + at) * N;
  const int* places = program_.positions.data() + group.positions - group.begin;
  F* target = matrix() + group.base + (k - group.begin) * group.stride;
  const int first = at / L * L;
  for (int i = first; i < panel.below; i += L) {
    W sum = load<F, L>(below + i) * g[0];
#pragma GCC unroll 8
    for (int j = 1; j < P; ++j) sum += load<F, L>(below + j * panel.stride + i) * g[j];
    if (group.contiguous) {
      if (i == first) {
#pragma GCC unroll 8
        for (int l = 0; l < L; ++l) sum[l] = i + l < at ? F(0) : sum[l];
      }
      F* to = target + places[k] + i - at;
      store<F, L>(to, load<F, L>(to) - sum);
    } else {
      store<F, L>(work_.data() + i - first, sum);
    }
  }
  if (group.contiguous) return;
  const F* sums = work_.data() + at - first;
  const int border = panel.below - panel.inside;
  for (int i = k; i < border; ++i) target[places[i]] -= sums[i - k];
}

}  // namespace mbs::compiled_ldl
