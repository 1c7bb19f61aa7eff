// Panels<F>: tables. Part of panels.hpp.
#pragma once

#include "panels.hpp"

namespace mbs::compiled_ldl {

template <typename F>
Panels<F>::Panels(const Program& program, bool definite)
    : program_(program),
      definite_(definite),
      constants_(program.storage + 2 * kMargin, F(0)),
      matrix_(program.storage + 2 * kMargin, F(0)) {
  for (const Front& front : program.fronts) add_front(front);
  int most = 0;
  for (const Panel& panel : panels_) most = std::max(most, panel.below);
  factors_.resize(next_factors_ + kMargin, F(0));
  work_.resize(most + 2 * kMargin, F(0));
}

template <typename F>
void Panels<F>::add_front(const Front& front) {
  for (int from = 0; from < front.pivots; from += kPanel) {
    const int pivots = std::min(kPanel, front.pivots - from);
    Panel panel;
    panel.first = front.first + from;
    panel.columns = front.base + from * front.stride + from;
    panel.stride = front.stride;
    panel.inside = front.pivots - from - pivots;
    panel.below = panel.inside + front.border;
    panel.rows = static_cast<int>(rows_.size());
    panel.groups_begin = front.groups_begin;
    panel.groups_end = front.groups_end;
    for (int i = 0; i < panel.inside; ++i) rows_.push_back(panel.first + pivots + i);
    for (int i = 0; i < front.border; ++i) rows_.push_back(program_.border_rows[front.rows + i]);
    panel.contiguous = panel.below > 0 && rows_.back() - rows_[panel.rows] == panel.below - 1;
    panel.factors = next_factors_;
    next_factors_ = panel.factors + lanes_for(pivots) * (2 * pivots + 1 + round_up(panel.below, 8));
    next_factors_ = round_up(next_factors_, 8);
    panels_.push_back(panel);
    add_run(panel_shape(front, from));
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
      throw std::logic_error("no kernel for " + std::to_string(shape.pivots) + " pivots");
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
      throw std::logic_error("no kernel for " + std::to_string(lanes) + " rows at a time");
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
