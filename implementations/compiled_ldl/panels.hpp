// The numbers of a program's fronts in panels of up to eight pivots, for one simulation.
#pragma once

#include <algorithm>

#include "panel_transpose.hpp"
#include "program.hpp"

namespace mbs::compiled_ldl {

/// A panel has the pivots' block L D Lᵀ and the rows C below. Stored are, so that both
/// substitutions are sums of columns: M = L⁻¹ by columns, Mᵀ by columns, D⁻¹, the rows of W = C L⁻ᵀ
/// D⁻¹, and C L⁻ᵀ in place of C.
template <typename F>
class Panels {
 public:
  /// `definite`: only positive pivots are accepted.
  Panels(const Program& program, bool definite);

  /// What every factorization begins with.
  F* constants() { return constants_.data() + kMargin; }
  /// The matrix, valid from start() until factorize_and_solve().
  F* matrix() { return matrix_.data() + kMargin; }
  void start() { std::copy(constants_.begin(), constants_.end(), matrix_.begin()); }

  /// Factorizes and solves for y, which is padded; false if a pivot is not accepted.
  bool factorize_and_solve(F* y);
  void solve(F* y) const;

 private:
  static constexpr int kMargin = 16;  // numbers before and behind, which vectors may touch
  struct Panel {
    int first = 0;    // row of the first pivot
    int columns = 0;  // storage of its diagonal block
    int stride = 0;
    int inside = 0;           // further columns of its front
    int below = 0;            // rows below, those of these columns included
    int factors = 0;          // where M, Mᵀ, D⁻¹ and W are
    int rows = 0;             // where the list of its rows below is
    bool contiguous = false;  // these rows follow each other
    int groups_begin = 0, groups_end = 0;
  };
  /// Panels of the same shape that follow each other.
  struct Run {
    int begin = 0, end = 0;
    bool (Panels::*eliminate)(const Run&, F*) = nullptr;
    void (Panels::*forward)(const Run&, F*) const = nullptr;
    void (Panels::*backward)(const Run&, F*) const = nullptr;
  };

  void add_front(const Front& front);
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
  /// Mᵀ z, of its columns.
  template <int P>
  static typename Short<F, lanes_for(P)>::Type times_transposed(
      const F* columns, const typename Short<F, lanes_for(P)>::Type& z);
  template <int P>
  void update_inside(const Panel& panel);
  template <int P>
  void update_two(const Panel& panel, const Group& group);
  template <int P, int L>
  void update_border(const Panel& panel);
  template <int P, int L>
  void update_column(const Panel& panel, const Group& group, int k);

  const Program& program_;
  bool definite_;
  Array<F> constants_, matrix_, factors_;
  std::vector<Panel> panels_;
  std::vector<Run> runs_;
  PanelShape last_shape_;  // while tables are made, as the next
  int next_factors_ = 0;
  std::vector<int> rows_;
  Array<F> work_;
};

}  // namespace mbs::compiled_ldl

#include "panels_eliminate.hpp"
#include "panels_setup.hpp"
#include "panels_solve.hpp"
#include "panels_update.hpp"
