// The numbers of a program's fronts, for one simulation; fronts of one panel, up to eight pivots.
#pragma once

#include <span>
#include <vector>

#include "panels/strips.hpp"
#include "panels/triangle.hpp"
#include "panels/vectors.hpp"
#include "panels/wide.hpp"
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

  /// What every factorization begins with, written before start().
  F* constants() {
    all_changed_ = true;
    return constants_.data() + kMargin;
  }
  /// The matrix, valid from start() until factorize_and_solve().
  F* matrix() { return matrix_.data() + kMargin; }
  void start();

  /// Fronts: the program's constant ones, or those behind them.
  enum class Part { all, constant, changing };
  /// Factorizes and solves for y, which is padded; false if a pivot is not accepted.
  bool factorize_and_solve(F* y, Part part = Part::all);
  void solve(F* y, Part part = Part::all);

 private:
  static constexpr int kMargin = 16;  // numbers before and behind, which vectors may touch
  struct Panel {
    int first = 0;    // row of the first pivot
    int columns = 0;  // storage
    int stride = 0;
    int below = 0;      // rows below: the border
    int factors = 0;    // where M, Mᵀ, D⁻¹ and W are
    int rows = 0;       // where Program::border_rows has its border
    int following = 0;  // how many of these rows follow each other, from the first on
    int strips_begin = 0, strips_end = 0;
    bool is_two = false;  // the border: two rows that are neighbours also where they go
  };
  /// Fronts of the same shape that follow each other: panels, or wide ones.
  struct Run {
    int begin = 0, end = 0;
    bool (Panels::*eliminate)(const Run&, F*) = nullptr;
    void (Panels::*forward)(const Run&, F*) = nullptr;
    void (Panels::*backward)(const Run&, F*) = nullptr;
  };

  [[nodiscard]] std::span<const Run> runs_of(Part part) const {
    const std::span<const Run> all(runs_);
    if (part == Part::all) return all;
    return part == Part::constant ? all.first(constant_runs_) : all.subspan(constant_runs_);
  }
  void add_front(const Front& front);
  void add_panel(const Front& front);
  void add_run(const FrontShape& shape, int last);
  template <int P>
  void choose_kernels(Run& run, const FrontShape& shape) const;
  template <int P, int L>
  void set_kernels(Run& run) const;
  template <int P>
  void set_wide_kernels(Run& run) const;

  template <int P, int L, bool kDefinite>
  bool eliminate(const Run& run, F* y);
  template <int P, int L, bool kDefinite>
  bool eliminate_panel(const Panel& panel, F* y);
  template <int P, int L, bool kDefinite>
  bool eliminate_in_scalars(const Panel& panel, F* y);
  template <int L, bool kDefinite>
  bool eliminate_pair(const Panel& panel, F* y);
  template <int P, int L>
  void forward(const Run& run, F* y);
  template <int P, int L>
  void backward(const Run& run, F* y);
  template <int P, bool kDefinite>
  bool eliminate_wide(const Run& run, F* y);
  template <int P>
  void forward_wide(const Run& run, F* y);
  template <int P>
  void backward_wide(const Run& run, F* y);
  template <int P, int L, typename Column>
  void reduce_below(const Panel& panel, const Column (&l)[P], const F (&inverse)[P]);
  template <int P, int L, typename Z>
  void subtract_below(const Panel& panel, const Z& z, F* y) const;
  template <int P>
  void update_two(const Panel& panel);
  template <int P, int L>
  void update_border(const Panel& panel);
  template <int P, int L>
  static void update_rows(const F* below, int stride, int rows, const F* g, int columns, F* target,
                          int target_stride);

  const Program& program_;
  bool definite_;
  bool all_changed_ = true;  // since start(), and not only what the program lists
  Array<F> constants_, matrix_, factors_;
  std::vector<Panel> panels_;
  std::vector<Run> runs_;
  std::size_t constant_runs_ = 0;
  FrontShape last_shape_;  // while tables are made, as the next
  int next_factors_ = 0;
  std::vector<Strip> strips_;
  WideFronts<F> wide_;
};

// These are compiled once, beside the steps.
extern template class Panels<double>;
extern template class Panels<float>;

}  // namespace mbs::compiled_ldl
