// Fronts of several panels, for one simulation: blocks of eight rows and columns.
#pragma once

#include <algorithm>
#include <vector>

#include "panels/strips.hpp"
#include "panels/triangle.hpp"
#include "panels/vectors.hpp"
#include "program.hpp"

namespace mbs::compiled_ldl {

/// Of each panel are stored what Panels has, M, Mᵀ, D⁻¹ and C L⁻ᵀ, but not W; the matrix stays what
/// it is. A panel takes up what those before it subtract, a few rows of all its columns at a time.
/// While these are in registers they become C L⁻ᵀ, and the right-hand side loses their C L⁻ᵀ z. So
/// the matrix is loaded once. C L⁻ᵀ of eight pivots' rows is a row of blocks, each column by
/// column: rows 16 … 23 have 16 columns of eight numbers, behind the 8 columns of rows 8 … 15. The
/// border's rows have columns of their own.
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
  void forward(int k, F* y);
  template <int P>
  void backward(int k, F* y);

 private:
  static constexpr int L = kWidest<F>;
  // Vectors of rows, and columns, whose sums are in registers at a time: 16 of 32, 12 of 16.
  static constexpr int kVectors = kRegisterDoubles == 8 ? 2 : 3;
  static constexpr int kColumns = kRegisterDoubles == 8 ? 8 : 4;
  static constexpr int kBlock = kPanel * kPanel;
  using W = typename Short<F, L>::Type;
  using Eight = typename Short<F, kPanel>::Type;
  struct Wide {
    int first = 0, pivots = 0, border = 0;
    int base = 0, stride = 0;    // of the matrix
    int panels = 0, length = 0;  // of the border's columns, a multiple of eight
    int inverses = 0;            // where D⁻¹ is
    int factors = 0;             // where M and Mᵀ of the first panel are
    int blocks = 0;              // where C L⁻ᵀ of the pivots' rows is
    int columns = 0;             // and of the border's
    int rows = 0;                // where Program::border_rows has its border
    int strips_begin = 0, strips_end = 0;
  };
  /// C L⁻ᵀ of some rows: its first column, and how far apart columns are.
  struct Rows {
    F* at;
    int stride;
  };

  /// Of the k-th eight pivots.
  Rows pivot_rows(const Wide& front, int k) {
    return {factors_.data() + front.blocks + kBlock / 2 * k * (k - 1), kPanel};
  }
  Rows border_rows(const Wide& front) { return {factors_.data() + front.columns, front.length}; }
  F* factors_of(const Wide& front, int k) {
    return factors_.data() + front.factors + 2 * kBlock * k;
  }

  F* take_right(const Wide& front, F* y);
  void give_right(const Wide& front, F* y) const;
  void add_border(const Wide& front, F* y) const;
  template <int P>
  static void store_pivots(F* right, const Eight& x);
  template <int kRows>
  void scale_rows(const Wide& front, const F* rows, int stride, int columns);
  template <int kFrom, int kTo, int P, int R>
  static void take_up(F* const (&rows)[R], int stride, const F* scaled, int columns, W (&s)[P][R]);
  template <int P, bool kDefinite>
  static bool eliminate_block(const F* block, F* factors, F* inverses, F (&lower)[P][kPanel],
                              F* z_of);
  template <int P, bool kDefinite>
  bool eliminate_panel(const Wide& front, const F* matrix, int k, F* right);
  template <int P, typename Vector>
  void finish_all(int stride, const F* target, const Vector& vector, int rows_stride, int count,
                  int from, const F* l, const F* z, F* right);
  template <int P, int R>
  void finish_rows(int stride, const F* target, F* const (&rows)[R], int rows_stride, int from,
                   const F* l, const F* z, F* right);
  template <int P>
  void forward_panel(const Wide& front, int k, F* right);
  template <int P>
  void backward_panel(const Wide& front, int k, F* right);
  void update_border(const Wide& front, F* matrix);
  template <int K>
  void update_columns(const Wide& front, F* matrix, const Strip& strip, int column);

  const Program& program_;
  std::vector<Wide> fronts_;
  std::vector<Strip> strips_;
  int next_ = 0, longest_ = 0;
  Array<F> factors_;
  Array<F> scaled_;  // eight rows of C L⁻ᵀ D⁻¹, column by column
  Array<F> right_;   // a right-hand side of a front, from a multiple of eight on the border's
};

template <typename F>
void WideFronts<F>::add(const Front& front) {
  Wide wide;
  wide.first = front.first;
  wide.pivots = front.pivots;
  wide.border = front.border;
  wide.base = front.base;
  wide.stride = front.stride;
  wide.panels = (front.pivots + kPanel - 1) / kPanel;
  wide.length = round_up(front.border, kPanel);
  wide.rows = front.rows;
  const int padded = wide.panels * kPanel;
  wide.inverses = next_;
  wide.factors = wide.inverses + padded;
  wide.blocks = wide.factors + wide.panels * 2 * kBlock;
  wide.columns = wide.blocks + kBlock / 2 * wide.panels * (wide.panels - 1);
  next_ = wide.columns + padded * wide.length;
  longest_ = std::max(longest_, padded + wide.length);
  wide.strips_begin = static_cast<int>(strips_.size());
  add_strips<F>(program_, front, strips_);
  wide.strips_end = static_cast<int>(strips_.size());
  fronts_.push_back(wide);
}

template <typename F>
void WideFronts<F>::allocate() {
  factors_.resize(next_ + kPanel, F(0));
  for (const Wide& front : fronts_) {
    for (int k = 0; kInScalars<F> && k < front.panels; ++k) {
      F* factors = factors_of(front, k);
      store_ones<F>(std::min(kPanel, front.pivots - k * kPanel), kPanel, factors, factors + kBlock);
    }
  }
  scaled_.resize(longest_ * kPanel, F(0));
  right_.resize(longest_, F(0));
}

}  // namespace mbs::compiled_ldl
