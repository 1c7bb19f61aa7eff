// The numbers of a program's fronts in panels of up to eight pivots, for one simulation.
#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>
#include <type_traits>

#include "panels/vectors.hpp"
#include "program.hpp"

namespace mbs::compiled_ldl {

/// A panel has the pivots' block L D Lᵀ and the rows C below. Stored are, so that both
/// substitutions are sums of columns: M = L⁻¹ by columns, Mᵀ by columns, D⁻¹, the rows of W = C L⁻ᵀ
/// D⁻¹, and C L⁻ᵀ in place of C.
///
/// Columns (4 2 | 2) and (· 5 | 9) with a row C = (2 9) below have L = (1 0; ½ 1), D = (4, 4),
/// hence M = (1 0; −½ 1), D⁻¹ = (¼, ¼), C L⁻ᵀ = (2 8) and W = (½ 2). Row and column behind lose 2 ·
/// ½ + 8 · 2 = 17. For y = (4 6 | 0): z = D⁻¹ M y = (1 1), and below 0 − (2 · 1 + 8 · 1) = −10.
template <typename F>
class Panels {
 public:
  /// `definite`: only positive pivots are accepted.
  Panels(const Program& program, bool definite);

  /// What every factorization begins with.
  F* constants() { return constants_.data() + kMargin; }
  /// The matrix, valid from start() until factorize_and_solve().
  F* matrix() { return matrix_.data() + kMargin; }
  void start() {
    for (const Copied& c : copied_) std::copy_n(constants() + c.begin, c.count, matrix() + c.begin);
  }

  /// Fronts: the program's constant ones, or those behind them.
  enum class Part { all, constant, changing };
  /// Factorizes and solves for y, which is padded; false if a pivot is not accepted.
  bool factorize_and_solve(F* y, Part part = Part::all);
  void solve(F* y, Part part = Part::all) const;

 private:
  static constexpr int kMargin = 16;  // numbers before and behind, which vectors may touch
  /// Two vectors of rows of a panel, and what becomes of them, need 32 registers.
  static constexpr bool kPairs = kRegisterDoubles == 8;
  /// Columns of more numbers are fetched ahead, and substituted by sums over lanes.
  static constexpr int kLarge = 64;
  /// What start() copies: fronts, of large ones the columns from their panel's diagonal on. What
  /// lies between, if it is short, is copied along.
  struct Copied {
    int begin = 0, count = 0;
  };
  struct Panel {
    int first = 0;    // row of the first pivot
    int columns = 0;  // storage of its diagonal block
    int stride = 0;
    int earlier = 0;    // panels of its front before it
    int inside = 0;     // further columns of its front
    int below = 0;      // rows below, those of these columns included
    int factors = 0;    // where M, Mᵀ, D⁻¹ and W are
    int rows = 0;       // where the list of its rows below is
    int following = 0;  // how many of these rows follow each other, from the first on
    int strips_begin = 0, strips_end = 0;
    bool is_two = false;  // the border: two rows that are neighbours also where they go
  };
  /// Rows of a front's border that follow each other also in the columns that they go to. Border
  /// rows 4, 5 and 9, of which a front with pivots 4, 5 and border 8, 9 owns columns 4 and 5 and
  /// has the rows in places 0, 1 and 3: two strips for it, of two rows and of one. Column 9 is
  /// another front's, with one strip.
  struct Strip {
    int begin = 0, rows = 0;      // of the border
    int column = 0, columns = 0;  // of the border: what is updated
    int target = 0, stride = 0;   // storage of row `begin` in the first of these columns
  };
  /// Panels of the same shape that follow each other.
  struct Run {
    int begin = 0, end = 0;
    bool (Panels::*eliminate)(const Run&, F*) = nullptr;
    void (Panels::*forward)(const Run&, F*) const = nullptr;
    void (Panels::*backward)(const Run&, F*) const = nullptr;
  };

  [[nodiscard]] std::span<const Run> runs_of(Part part) const {
    const std::span<const Run> all(runs_);
    if (part == Part::all) return all;
    return part == Part::constant ? all.first(constant_runs_) : all.subspan(constant_runs_);
  }
  void add_front(const Front& front);
  void add_strips(const Front& front);
  void add_copied(const Front& front);
  void add_run(const PanelShape& shape);
  template <int P>
  void choose_kernels(Run& run, int lanes) const;
  template <int P, int L>
  void set_kernels(Run& run) const;

  template <int P, int L, bool kDefinite>
  bool eliminate(const Run& run, F* y);
  template <int P, int L, bool kDefinite>
  bool eliminate_panel(const Panel& panel, F* y);
  template <int L, bool kDefinite>
  bool eliminate_pair(const Panel& panel, F* y);
  template <int P, int L>
  void forward(const Run& run, F* y) const;
  template <int P, int L>
  void backward(const Run& run, F* y) const;
  template <int P, int L>
  void reduce_below(const Panel& panel, const typename Short<F, lanes_for(P)>::Type (&l)[P],
                    const F (&inverse)[P]);
  template <int P, int L>
  void subtract_below(const Panel& panel, const typename Short<F, lanes_for(P)>::Type& z,
                      F* y) const;
  typename Short<F, kPanel>::Type times_inside(const Panel& panel, const F* x) const;
  /// Mᵀ z, of its columns.
  template <int P>
  static typename Short<F, lanes_for(P)>::Type times_transposed(
      const F* columns, const typename Short<F, lanes_for(P)>::Type& z);
  template <int P>
  void take_up_earlier(const Panel& panel);
  template <int P, int R>
  void take_up_rows(const Panel& panel, int row);
  template <int P>
  void update_two(const Panel& panel);
  template <int P, int L>
  void update_border(const Panel& panel);
  template <int P, int L>
  static void update_rows(const F* below, int stride, int rows, const F* g, int columns, F* target,
                          int target_stride);
  template <int P>
  void update_border_at_once(const Panel& last);
  template <int P, int K>
  void update_columns(const Panel& last, const Strip& strip, int column);

  const Program& program_;
  bool definite_;
  Array<F> constants_, matrix_, factors_;
  std::vector<Panel> panels_;
  std::vector<Run> runs_;
  std::size_t constant_runs_ = 0;
  PanelShape last_shape_;  // while tables are made, as the next
  int next_factors_ = 0;
  std::vector<int> rows_;
  std::vector<Strip> strips_;
  std::vector<Copied> copied_;
};

// Tables.

template <typename F>
Panels<F>::Panels(const Program& program, bool definite)
    : program_(program),
      definite_(definite),
      constants_(program.storage + 2 * kMargin, F(0)),
      matrix_(program.storage + 2 * kMargin, F(0)) {
  for (int k = 0; k < static_cast<int>(program.fronts.size()); ++k) {
    if (k == program.constant_fronts) {
      constant_runs_ = runs_.size();
      last_shape_ = {};  // begins a run
    }
    add_front(program.fronts[k]);
  }
  factors_.resize(next_factors_ + kMargin, F(0));
}

template <typename F>
void Panels<F>::add_front(const Front& front) {
  const int strips_begin = static_cast<int>(strips_.size());
  add_strips(front);
  add_copied(front);
  const int strips_end = static_cast<int>(strips_.size());
  for (int from = 0; from < front.pivots; from += kPanel) {
    const int pivots = std::min(kPanel, front.pivots - from);
    Panel panel;
    panel.first = front.first + from;
    panel.columns = front.base + from * front.stride + from;
    panel.stride = front.stride;
    panel.earlier = from / kPanel;
    panel.inside = front.pivots - from - pivots;
    panel.below = panel.inside + front.border;
    panel.rows = static_cast<int>(rows_.size());
    panel.strips_begin = strips_begin;
    panel.strips_end = strips_end;
    panel.is_two = front.border == 2 && strips_end - strips_begin == 1;
    for (int i = 0; i < panel.inside; ++i) rows_.push_back(panel.first + pivots + i);
    for (int i = 0; i < front.border; ++i) rows_.push_back(program_.border_rows[front.rows + i]);
    while (panel.following < panel.below &&
           rows_[panel.rows + panel.following] == rows_[panel.rows] + panel.following) {
      ++panel.following;
    }
    panel.factors = next_factors_;
    next_factors_ = panel.factors + lanes_for(pivots) * (2 * pivots + 1 + round_up(panel.below, 8));
    next_factors_ = round_up(next_factors_, 8);
    panels_.push_back(panel);
    add_run(panel_shape(front, from));
  }
}

template <typename F>
void Panels<F>::add_strips(const Front& front) {
  for (int g = front.groups_begin; g < front.groups_end; ++g) {
    const Group& group = program_.groups[g];
    const int* places = program_.positions.data() + group.positions - group.begin;
    const int most = front.border <= 4 ? lanes_for(front.border) : kWidest<F>;
    for (int i = group.begin; i < front.border;) {
      Strip strip;
      strip.begin = i;
      while (i < front.border && i - strip.begin < most &&
             places[i] - places[strip.begin] == i - strip.begin) {
        ++i;
      }
      strip.rows = i - strip.begin;
      strip.column = group.begin;
      strip.columns = std::min(group.end, i) - group.begin;
      strip.target = group.base + places[strip.begin];
      strip.stride = group.stride;
      strips_.push_back(strip);
    }
  }
}

template <typename F>
void Panels<F>::add_copied(const Front& front) {
  constexpr int kWhole = 4 * kPanel;  // columns; of few rows, parts take longer than all
  for (int j = 0; j < front.pivots; ++j) {
    const int above = j < kWhole ? 0 : j / kPanel * kPanel;
    const int begin = front.base + j * front.stride + above, count = front.stride - above;
    if (!copied_.empty() && begin - (copied_.back().begin + copied_.back().count) <= kMargin) {
      copied_.back().count = begin + count - copied_.back().begin;
    } else {
      copied_.push_back({begin, count});
    }
  }
}

template <typename F>
void Panels<F>::add_run(const PanelShape& shape) {
  const int last = static_cast<int>(panels_.size()) - 1;
  if (!runs_.empty() && last_shape_ == shape) {
    runs_.back().end = last + 1;
    return;
  }
  last_shape_ = shape;
  Run run;
  run.begin = last;
  run.end = last + 1;
  switch (shape.pivots) {
    case 1:
      choose_kernels<1>(run, shape.lanes);
      break;
    case 2:
      choose_kernels<2>(run, shape.lanes);
      break;
    case 3:
      choose_kernels<3>(run, shape.lanes);
      break;
    case 4:
      choose_kernels<4>(run, shape.lanes);
      break;
    case 5:
      choose_kernels<5>(run, shape.lanes);
      break;
    case 6:
      choose_kernels<6>(run, shape.lanes);
      break;
    case 7:
      choose_kernels<7>(run, shape.lanes);
      break;
    case 8:
      choose_kernels<8>(run, shape.lanes);
      break;
    default:
      throw std::logic_error("no kernel has so many pivots");
  }
  runs_.push_back(run);
}

template <typename F>
template <int P>
void Panels<F>::choose_kernels(Run& run, int lanes) const {
  switch (lanes) {
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

// Elimination of a run of panels.

template <typename F>
bool Panels<F>::factorize_and_solve(F* y, Part part) {
  bool accepted = true;
  const auto runs = runs_of(part);
  for (const Run& run : runs) accepted &= (this->*run.eliminate)(run, y);
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) (this->*run->backward)(*run, y);
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
  if (panel.earlier > 0) take_up_earlier<P>(panel);
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
  if (panel.earlier > 0) take_up_earlier<2>(panel);
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

// What an eliminated panel subtracts from the rows and columns after it.

/// y −= C z at the rows below.
template <typename F>
template <int P, int L>
void Panels<F>::subtract_below(const Panel& panel, const typename Short<F, lanes_for(P)>::Type& z,
                               F* y) const {
  using W = typename Short<F, L>::Type;
  const F* below = matrix_.data() + kMargin + panel.columns + P;
  const int* rows = rows_.data() + panel.rows;
  for (int i = 0; i < panel.below; i += L) {
    const int count = std::min(L, panel.below - i);
    W sum = load<F, L>(below + i) * z[0];
#pragma GCC unroll 8
    for (int j = 1; j < P; ++j) sum += load<F, L>(below + j * panel.stride + i) * z[j];
    if (L > 4 && i + count <= panel.following) {
      store<F, L>(y + rows[i], load<F, L>(y + rows[i]) - first_lanes<F, L>(sum, count));
    } else {
      for (int l = 0; l < count; ++l) y[rows[i + l]] -= sum[l];
    }
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

/// The panel's columns lose what the earlier panels of its front subtract, in one go.
template <typename F>
template <int P>
void Panels<F>::take_up_earlier(const Panel& panel) {
  constexpr int L = kWidest<F>;
  const int rows = P + panel.below;
  int i = 0;
  if constexpr (kPairs) {
    for (; i + L < rows; i += 2 * L) take_up_rows<P, 2>(panel, i);
  }
  for (; i < rows; i += L) take_up_rows<P, 1>(panel, i);
}

/// R vectors of rows, from `row` of the panel on.
template <typename F>
template <int P, int R>
void Panels<F>::take_up_rows(const Panel& panel, int row) {
  constexpr int L = kWidest<F>, kAhead = 24;
  using W = typename Short<F, L>::Type;
  F* target = matrix() + panel.columns + row;
  // Columns lie too far apart for the processor to see which comes next. Those of a short front are
  // in the cache, and what lies that far behind is not its own.
  const bool large = panel.stride > kLarge;
  W s[P][R];
#pragma GCC unroll 8
  for (int k = 0; k < P; ++k) {
#pragma GCC unroll 2
    for (int r = 0; r < R; ++r) s[k][r] = load<F, L>(target + k * panel.stride + r * L);
  }
  for (const Panel* from = &panel - panel.earlier; from != &panel; ++from) {
    const int behind = panel.first - from->first;
    const F* below = matrix() + from->columns + behind + row;
    const F* g = factors_.data() + from->factors + (kPanel + 1 + behind) * kPanel;
    for (int j = 0; j < kPanel; ++j) {
      W c[R];
      if (large) {
        __builtin_prefetch(below + (j + kAhead) * panel.stride);
        if (R > 1) __builtin_prefetch(below + (j + kAhead) * panel.stride + (R - 1) * L);
      }
#pragma GCC unroll 2
      for (int r = 0; r < R; ++r) c[r] = load<F, L>(below + j * panel.stride + r * L);
#pragma GCC unroll 8
      for (int k = 0; k < P; ++k) {
        const F of_column = g[k * kPanel + j];
#pragma GCC unroll 2
        for (int r = 0; r < R; ++r) s[k][r] -= c[r] * of_column;
      }
    }
  }
#pragma GCC unroll 8
  for (int k = 0; k < P; ++k) {
#pragma GCC unroll 2
    for (int r = 0; r < R; ++r) store<F, L>(target + k * panel.stride + r * L, s[k][r]);
  }
}

template <typename F>
template <int P, int L>
void Panels<F>::update_border(const Panel& panel) {
  if (panel.inside > 0) return;  // the last panel of the front does it for all
  if (panel.earlier > 0) return update_border_at_once<P>(panel);
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

/// What all panels of a front subtract from others, in one go. `last`: of its panels.
template <typename F>
template <int P>
void Panels<F>::update_border_at_once(const Panel& last) {
  for (int i = last.strips_begin; i < last.strips_end; ++i) {
    const Strip& strip = strips_[i];
    int k = 0;
    for (; k + 8 <= strip.columns; k += 8) update_columns<P, 8>(last, strip, k);
    if (k + 4 <= strip.columns) {
      update_columns<P, 4>(last, strip, k);
      k += 4;
    }
    const int left = strip.columns - k;
    if (left == 3) update_columns<P, 3>(last, strip, k);
    if (left == 2) update_columns<P, 2>(last, strip, k);
    if (left == 1) update_columns<P, 1>(last, strip, k);
  }
}

/// K columns of a strip, from `column` of it on.
template <typename F>
template <int P, int K>
void Panels<F>::update_columns(const Panel& last, const Strip& strip, int column) {
  constexpr int L = std::max(4, kWidest<F>), N = lanes_for(P);  // a strip may have four rows
  using W = typename Short<F, L>::Type;
  F* target = matrix() + strip.target + column * strip.stride;
  W s[K];
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k) s[k] = load<F, L>(target + k * strip.stride);
  const auto subtract = [&](const F* below, const F* g, int pivots, auto lanes) {
    for (int j = 0; j < pivots; ++j) {
      const W c = first_lanes<F, L>(load<F, L>(below + j * last.stride), strip.rows);
#pragma GCC unroll 8
      for (int k = 0; k < K; ++k) s[k] -= c * g[k * lanes + j];
    }
  };
  const int row = strip.begin, of_column = strip.column + column;
  for (const Panel* from = &last - last.earlier; from != &last; ++from) {
    subtract(matrix() + from->columns + kPanel + from->inside + row,
             factors_.data() + from->factors + (2 * kPanel + 1 + from->inside + of_column) * kPanel,
             kPanel, std::integral_constant<int, kPanel>());
  }
  subtract(matrix() + last.columns + P + row,
           factors_.data() + last.factors + (2 * P + 1 + of_column) * N, P,
           std::integral_constant<int, N>());
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k) store<F, L>(target + k * strip.stride, s[k]);
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

template <typename F>
void Panels<F>::solve(F* y, Part part) const {
  const auto runs = runs_of(part);
  for (const Run& run : runs) (this->*run.forward)(run, y);
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) (this->*run->backward)(*run, y);
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

/// (C L⁻ᵀ)ᵀ x, of the further pivots of its front. Of large fronts, C is in the cache of every
/// substitution, unlike W.
template <typename F>
typename Short<F, kPanel>::Type Panels<F>::times_inside(const Panel& panel, const F* x) const {
  constexpr int L = kWidest<F>;
  using W = typename Short<F, L>::Type;
  const F* below = matrix_.data() + kMargin + panel.columns + kPanel;
  W sums[kPanel] = {};
  for (int i = 0; i < panel.inside; i += L) {
    const W x_i = first_lanes<F, L>(load<F, L>(x + i), panel.inside - i);
#pragma GCC unroll 8
    for (int j = 0; j < kPanel; ++j) sums[j] += load<F, L>(below + j * panel.stride + i) * x_i;
  }
  return lane_sums<F>(sums);
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
    const F* factors = factors_.data() + panel.factors;
    const F* transposed = factors + P * N;
    const F* g = transposed + (P + 1) * N;
    const int* rows = rows_.data() + panel.rows;
    V x0 = load<F, N>(y + panel.first), x1 = V{}, x2 = V{}, x3 = V{};
    int k = 0;
    if constexpr (P == kPanel) {
      if (panel.inside > kLarge) {
        x0 -= load<F, N>(factors + 2 * P * N) * times_inside(panel, y + panel.first + P);
        k = panel.inside;
      }
    }
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
