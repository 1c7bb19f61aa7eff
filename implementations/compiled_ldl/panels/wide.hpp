// Fronts of several panels, for one simulation: blocks of eight rows and columns.
#pragma once

#include <algorithm>
#include <type_traits>
#include <vector>

#include "panels/strips.hpp"
#include "panels/vectors.hpp"
#include "program.hpp"

namespace mbs::compiled_ldl {

/// Of each panel are stored what Panels has, M, Mᵀ, D⁻¹ and C L⁻ᵀ in place of C, but not W. A
/// panel takes up what those before it subtract, a few rows of all its columns at a time. While
/// these are in registers they become C L⁻ᵀ, and the right-hand side below loses their C z. So the
/// matrix is loaded and stored once. Rows are counted from the front's first; columns begin on
/// multiples of eight numbers, and so do panels.
template <typename F>
class WideFronts {
 public:
  explicit WideFronts(const Program& program) : program_(program) {}

  /// After the last one, allocate().
  void add(const Front& front);
  void allocate();
  [[nodiscard]] int count() const { return static_cast<int>(fronts_.size()); }

  // Of front k, whose last panel has P pivots.
  /// Factorizes and substitutes y forward; false if a pivot is not accepted.
  template <int P, bool kDefinite>
  bool eliminate(int k, F* matrix, F* y);
  template <int P>
  void forward(int k, const F* matrix, F* y);
  template <int P>
  void backward(int k, const F* matrix, F* y);

 private:
  static constexpr int L = kWidest<F>;
  static constexpr int kPairs = kRegisterDoubles == 8 ? 2 : 1;  // vectors of rows at a time
  static constexpr int kOfPanel = 2 * kPanel * kPanel;          // numbers of M and Mᵀ
  /// Columns of more numbers are fetched ahead.
  static constexpr int kLarge = 64;
  using W = typename Short<F, L>::Type;
  using Eight = typename Short<F, kPanel>::Type;
  struct Wide {
    int first = 0, pivots = 0, border = 0;
    int base = 0, stride = 0;
    int padded = 0;    // rows, a multiple of eight
    int inverses = 0;  // where D⁻¹ is
    int factors = 0;   // where M and Mᵀ of the first panel are
    int rows = 0;      // where Program::border_rows has its border
    int strips_begin = 0, strips_end = 0;
  };

  void take_right(const Wide& front, const F* y);
  void scale_rows(const Wide& front, const F* rows, int columns);
  template <int P, int R>
  static void take_up(const F* rows, int stride, const F* scaled, int columns, W (&s)[P][R]);
  template <int P, bool kDefinite>
  bool eliminate_panel(const Wide& front, F* columns, int from);
  template <int P, int R>
  void finish_rows(const Wide& front, F* columns, int from, int row, const F* l, const F* z);
  template <int P>
  void forward_panel(const Wide& front, const F* columns, int from);
  template <int P>
  void backward_panel(const Wide& front, const F* columns, int from);
  void update_border(const Wide& front, F* matrix);
  template <int K>
  void update_columns(const Wide& front, F* matrix, const Strip& strip, int column) const;

  const Program& program_;
  std::vector<Wide> fronts_;
  std::vector<Strip> strips_;
  int next_ = 0, longest_ = 0;
  Array<F> factors_;
  Array<F> scaled_;  // eight rows of C L⁻ᵀ D⁻¹, column by column
  Array<F> right_;   // a right-hand side of a front, what its border loses behind it
};

template <typename F>
void WideFronts<F>::add(const Front& front) {
  Wide wide;
  wide.first = front.first;
  wide.pivots = front.pivots;
  wide.border = front.border;
  wide.base = front.base;
  wide.stride = front.stride;
  wide.padded = round_up(front.pivots + front.border, kPanel);
  wide.rows = front.rows;
  const int columns = round_up(front.pivots, kPanel);
  wide.inverses = next_;
  wide.factors = next_ + columns;
  next_ = wide.factors + columns / kPanel * kOfPanel;
  longest_ = std::max(longest_, wide.padded);
  wide.strips_begin = static_cast<int>(strips_.size());
  add_strips<F>(program_, front, strips_);
  wide.strips_end = static_cast<int>(strips_.size());
  fronts_.push_back(wide);
}

template <typename F>
void WideFronts<F>::allocate() {
  factors_.resize(next_, F(0));
  scaled_.resize(longest_ * kPanel, F(0));
  right_.resize(longest_, F(0));
}

// Elimination from the left.

template <typename F>
void WideFronts<F>::take_right(const Wide& front, const F* y) {
  std::copy_n(y + front.first, front.pivots, right_.data());
  std::fill(right_.data() + front.pivots, right_.data() + front.padded, F(0));
}

template <typename F>
template <int P, bool kDefinite>
bool WideFronts<F>::eliminate(int k, F* matrix, F* y) {
  const Wide& front = fronts_[k];
  F* columns = matrix + front.base;
  take_right(front, y);
  bool accepted = true;
  int from = 0;
  for (; from + kPanel < front.pivots; from += kPanel) {
    accepted &= eliminate_panel<kPanel, kDefinite>(front, columns, from);
  }
  accepted &= eliminate_panel<P, kDefinite>(front, columns, from);
  std::copy_n(right_.data(), front.pivots, y + front.first);
  if (front.border == 0) return accepted;
  const int* rows = program_.border_rows.data() + front.rows;
  for (int i = 0; i < front.border; ++i) y[rows[i]] += right_[front.pivots + i];
  update_border(front, matrix);
  return accepted;
}

/// scaled_ = D⁻¹ C of eight rows in the first so many columns.
template <typename F>
void WideFronts<F>::scale_rows(const Wide& front, const F* rows, int columns) {
  const F* inverse = factors_.data() + front.inverses;
  F* scaled = scaled_.data();
  for (int j = 0; j < columns; ++j) {
#pragma GCC unroll 4
    for (int i = 0; i < kPanel; i += L) {
      store<F, L>(scaled + j * kPanel + i, load<F, L>(rows + j * front.stride + i) * inverse[j]);
    }
  }
}

/// s −= C D⁻¹ Cᵀ of the first so many columns: C of R vectors of rows, D⁻¹ Cᵀ of P columns.
template <typename F>
template <int P, int R>
[[gnu::always_inline]] inline void WideFronts<F>::take_up(const F* rows, int stride,
                                                          const F* scaled, int columns,
                                                          W (&s)[P][R]) {
  constexpr int kAhead = 24;
  // Columns lie too far apart for the processor to see which comes next. Those of a short front are
  // in the cache, and what lies that far behind is not its own.
  const bool large = stride > kLarge;
  for (int j = 0; j < columns; ++j, rows += stride, scaled += kPanel) {
    W c[R];
#pragma GCC unroll 2
    for (int r = 0; r < R; ++r) {
      if (large) __builtin_prefetch(rows + kAhead * stride + r * L);
      c[r] = load<F, L>(rows + r * L);
    }
#pragma GCC unroll 8
    for (int k = 0; k < P; ++k) {
      const F of_column = scaled[k];
#pragma GCC unroll 2
      for (int r = 0; r < R; ++r) s[k][r] -= c[r] * of_column;
    }
  }
}

template <typename F>
template <int P, bool kDefinite>
bool WideFronts<F>::eliminate_panel(const Wide& front, F* columns, int from) {
  F* diagonal = columns + from * front.stride + from;
  F* inverses = factors_.data() + front.inverses + from;
  F* factors = factors_.data() + front.factors + from / kPanel * kOfPanel;
  F* right = right_.data() + from;
  scale_rows(front, columns + from, from);
  alignas(64) F block[P * kPanel];
#pragma GCC unroll 4
  for (int i = 0; i < kPanel; i += L) {
    W s[P][1];
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) s[j][0] = load<F, L>(diagonal + j * front.stride + i);
    take_up<P, 1>(columns + from + i, front.stride, scaled_.data(), from, s);
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) store<F, L>(block + j * kPanel + i, s[j][0]);
  }
  Eight a[P], l[P], m[P];
  F inverse[P];
#pragma GCC unroll 8
  for (int j = 0; j < P; ++j) a[j] = load<F, kPanel>(block + j * kPanel);
  const bool accepted = decompose<F, P, kDefinite>(a, l, inverse);
  invert_triangle<F, P>(l, m);
  Eight scale = Eight{}, z = Eight{};
#pragma GCC unroll 8
  for (int j = 0; j < P; ++j) {
    store<F, kPanel>(block + j * kPanel, l[j]);
    store<F, kPanel>(factors + j * kPanel, m[j]);
    scale[j] = inverse[j];
    z += m[j] * right[j];
  }
  store_transposed<F, P, P, kPanel>(m, factors + kPanel * kPanel);
  store<F, kPanel>(inverses, scale);
  z *= scale;
  if constexpr (P < kPanel) {  // the first rows of the border
    Eight below = load<F, kPanel>(right);
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) {
      store<F, kPanel>(diagonal + j * front.stride, a[j]);
      below -= a[j] * z[j];
    }
    z = first_lanes_or<F, kPanel>(z, below, P);
  }
  store<F, kPanel>(right, z);
  int row = from + kPanel;
  for (; row + kPairs * L <= front.padded; row += kPairs * L) {
    finish_rows<P, kPairs>(front, columns, from, row, block, right);
  }
  for (; row < front.padded; row += L) {
    finish_rows<P, 1>(front, columns, from, row, block, right);
  }
  return accepted;
}

/// R vectors of rows below the panel's block, of which `l` has L and `z` the solution.
template <typename F>
template <int P, int R>
void WideFronts<F>::finish_rows(const Wide& front, F* columns, int from, int row, const F* l,
                                const F* z) {
  F* target = columns + from * front.stride + row;
  W s[P][R];
#pragma GCC unroll 8
  for (int k = 0; k < P; ++k) {
#pragma GCC unroll 2
    for (int r = 0; r < R; ++r) s[k][r] = load<F, L>(target + k * front.stride + r * L);
  }
  take_up<P, R>(columns + row, front.stride, scaled_.data(), from, s);
  F* right = right_.data() + row;
  W y[R];
#pragma GCC unroll 2
  for (int r = 0; r < R; ++r) y[r] = load<F, L>(right + r * L);
#pragma GCC unroll 8
  for (int k = 0; k < P; ++k) {
#pragma GCC unroll 8
    for (int j = 0; j < k; ++j) {
      const F l_kj = l[j * kPanel + k];
#pragma GCC unroll 2
      for (int r = 0; r < R; ++r) s[k][r] -= s[j][r] * l_kj;
    }
    const F z_k = z[k];
#pragma GCC unroll 2
    for (int r = 0; r < R; ++r) {
      y[r] -= s[k][r] * z_k;
      store<F, L>(target + k * front.stride + r * L, s[k][r]);
    }
  }
#pragma GCC unroll 2
  for (int r = 0; r < R; ++r) store<F, L>(right + r * L, y[r]);
}

// What the border subtracts from other fronts, for all panels in one go.

template <typename F>
void WideFronts<F>::update_border(const Wide& front, F* matrix) {
  const F* border = matrix + front.base + front.pivots;
  for (int begin = front.strips_begin, end; begin < front.strips_end; begin = end) {
    const int first = strips_[begin].column;
    for (end = begin; end < front.strips_end && strips_[end].column == first;) ++end;
    for (int k = 0; k < strips_[end - 1].columns; k += kPanel) {
      scale_rows(front, border + first + k, front.pivots);
      for (int i = begin; i < end; ++i) update_columns<kPanel>(front, matrix, strips_[i], k);
    }
  }
}

/// The columns of a strip from `column` on, at most K. scaled_ has their rows.
template <typename F>
template <int K>
void WideFronts<F>::update_columns(const Wide& front, F* matrix, const Strip& strip,
                                   int column) const {
  if (strip.columns - column < K) {
    if constexpr (K > 1) update_columns<K - 1>(front, matrix, strip, column);
    return;
  }
  constexpr int N = std::max(4, L);  // a strip may have four rows
  using V = typename Short<F, N>::Type;
  F* target = matrix + strip.target + column * strip.stride;
  const F* rows = matrix + front.base + front.pivots + strip.begin;
  const F* scaled = scaled_.data();
  V s[K];
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k) s[k] = load<F, N>(target + k * strip.stride);
  for (int j = 0; j < front.pivots; ++j, rows += front.stride, scaled += kPanel) {
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
void WideFronts<F>::forward(int k, const F* matrix, F* y) {
  const Wide& front = fronts_[k];
  const F* columns = matrix + front.base;
  take_right(front, y);
  int from = 0;
  for (; from + kPanel < front.pivots; from += kPanel) forward_panel<kPanel>(front, columns, from);
  forward_panel<P>(front, columns, from);
  std::copy_n(right_.data(), front.pivots, y + front.first);
  const int* rows = program_.border_rows.data() + front.rows;
  for (int i = 0; i < front.border; ++i) y[rows[i]] += right_[front.pivots + i];
}

/// z = D⁻¹ M y in place of the pivots' y; y −= C L⁻ᵀ z below.
template <typename F>
template <int P>
void WideFronts<F>::forward_panel(const Wide& front, const F* columns, int from) {
  const F* factors = factors_.data() + front.factors + from / kPanel * kOfPanel;
  const F* panel = columns + from * front.stride;
  F* right = right_.data();
  Eight z = times_columns<F, P, kPanel>(factors, load<F, kPanel>(right + from));
  z *= load<F, kPanel>(factors_.data() + front.inverses + from);
  Eight block = z;
  if constexpr (P < kPanel) {
    Eight below = load<F, kPanel>(right + from);
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) below -= load<F, kPanel>(panel + j * front.stride + from) * z[j];
    block = first_lanes_or<F, kPanel>(z, below, P);
  }
  store<F, kPanel>(right + from, block);
  for (int i = from + kPanel; i < front.padded; i += L) {
    W even = load<F, L>(right + i), odd = W{};
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) {
      W& sum = j % 2 == 0 ? even : odd;
      sum -= load<F, L>(panel + j * front.stride + i) * z[j];
    }
    store<F, L>(right + i, even + odd);
  }
}

template <typename F>
template <int P>
void WideFronts<F>::backward(int k, const F* matrix, F* y) {
  const Wide& front = fronts_[k];
  const F* columns = matrix + front.base;
  take_right(front, y);
  const int* rows = program_.border_rows.data() + front.rows;
  for (int i = 0; i < front.border; ++i) right_[front.pivots + i] = y[rows[i]];
  int from = (front.pivots - 1) / kPanel * kPanel;
  backward_panel<P>(front, columns, from);
  while ((from -= kPanel) >= 0) backward_panel<kPanel>(front, columns, from);
  std::copy_n(right_.data(), front.pivots, y + front.first);
}

/// x = Mᵀ (z − D⁻¹ (C L⁻ᵀ)ᵀ x below).
template <typename F>
template <int P>
void WideFronts<F>::backward_panel(const Wide& front, const F* columns, int from) {
  const F* factors = factors_.data() + front.factors + from / kPanel * kOfPanel;
  F* right = right_.data();
  const F* panel = columns + from * front.stride;
  W sums[kPanel] = {};
  const auto add = [&](int row, const W& x) {
#pragma GCC unroll 8
    for (int j = 0; j < P; ++j) sums[j] += load<F, L>(panel + j * front.stride + row) * x;
  };
  for (int i = from + kPanel; i < front.padded; i += L) add(i, load<F, L>(right + i));
  Eight z = load<F, kPanel>(right + from);
  if constexpr (P < kPanel) {  // rows of the border in the panel's block
    for (int i = 0; i < kPanel; i += L) {
      add(from + i, first_lanes_or<F, L>(W{}, load<F, L>(right + from + i), P - i));
    }
  }
  z -= load<F, kPanel>(factors_.data() + front.inverses + from) * lane_sums<F>(sums);
  Eight x = times_columns<F, P, kPanel>(factors + kPanel * kPanel, z);
  if constexpr (P < kPanel) x = first_lanes_or<F, kPanel>(x, load<F, kPanel>(right + from), P);
  store<F, kPanel>(right + from, x);
}

}  // namespace mbs::compiled_ldl
