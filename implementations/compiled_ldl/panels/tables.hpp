// Panels: fronts in runs of one shape; factorization and solve, run by run. Part of panels.hpp.
#pragma once

#include <stdexcept>

#include "panels/panels.hpp"

namespace mbs::compiled_ldl {

template <typename F>
Panels<F>::Panels(const Program& program, bool definite)
    : program_(program),
      definite_(definite),
      constants_(program.storage + 2 * kMargin, F(0)),
      matrix_(program.storage + 2 * kMargin, F(0)),
      wide_(program) {
  for (int k = 0; k < static_cast<int>(program.fronts.size()); ++k) {
    if (k == program.constant_fronts) {
      constant_runs_ = runs_.size();
      last_shape_ = {};  // begins a run
    }
    add_front(program.fronts[k]);
  }
  factors_.resize(next_factors_ + kMargin, F(0));
  wide_.allocate();
}

template <typename F>
void Panels<F>::add_front(const Front& front) {
  const FrontShape shape = front_shape(front);
  if (shape.wide) {
    wide_.add(front);
    return add_run(shape, wide_.count() - 1);
  }
  add_panel(front);
  add_run(shape, static_cast<int>(panels_.size()) - 1);
}

template <typename F>
void Panels<F>::add_panel(const Front& front) {
  Panel panel;
  panel.first = front.first;
  panel.columns = front.base;
  panel.stride = front.stride;
  panel.below = front.border;
  panel.rows = front.rows;
  const int* rows = program_.border_rows.data() + front.rows;
  while (panel.following < panel.below && rows[panel.following] == rows[0] + panel.following) {
    ++panel.following;
  }
  panel.factors = next_factors_;
  next_factors_ += lanes_for(front.pivots) * (2 * front.pivots + 1 + round_up(panel.below, 8));
  next_factors_ = round_up(next_factors_, 8);
  if constexpr (kInScalars<F>) {
    const int lanes = lanes_for(front.pivots);
    factors_.resize(next_factors_ + kMargin, F(0));
    F* factors = factors_.data() + panel.factors;
    store_ones(front.pivots, lanes, factors, factors + front.pivots * lanes);
  }
  panel.strips_begin = static_cast<int>(strips_.size());
  add_strips<F>(program_, front, strips_);
  panel.strips_end = static_cast<int>(strips_.size());
  panel.is_two = front.border == 2 && panel.strips_end - panel.strips_begin == 1;
  panels_.push_back(panel);
}

/// `last`: number of the new panel or wide front.
template <typename F>
void Panels<F>::add_run(const FrontShape& shape, int last) {
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
      choose_kernels<1>(run, shape);
      break;
    case 2:
      choose_kernels<2>(run, shape);
      break;
    case 3:
      choose_kernels<3>(run, shape);
      break;
    case 4:
      choose_kernels<4>(run, shape);
      break;
    case 5:
      choose_kernels<5>(run, shape);
      break;
    case 6:
      choose_kernels<6>(run, shape);
      break;
    case 7:
      choose_kernels<7>(run, shape);
      break;
    case 8:
      choose_kernels<8>(run, shape);
      break;
    default:
      throw std::logic_error("no kernel has so many pivots");
  }
  runs_.push_back(run);
}

// Factorization and solve.

template <typename F>
void Panels<F>::start() {
  const F* from = constants_.data() + kMargin;
  if (all_changed_) {
    std::copy(constants_.begin(), constants_.end(), matrix_.begin());
    all_changed_ = false;
    return;
  }
  constexpr int L = kWidest<F>;
  for (const Range& range : program_.changing) {
    for (int i = range.begin; i < range.end; i += L)
      store<F, L>(matrix() + i, load<F, L>(from + i));
  }
}

template <typename F>
bool Panels<F>::factorize_and_solve(F* y, Part part) {
  bool accepted = true;
  const auto runs = runs_of(part);
  for (const Run& run : runs) accepted &= (this->*run.eliminate)(run, y);
  all_changed_ |= !accepted;  // what is not a number may be anywhere
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) (this->*run->backward)(*run, y);
  return accepted;
}

template <typename F>
void Panels<F>::solve(F* y, Part part) {
  const auto runs = runs_of(part);
  for (const Run& run : runs) (this->*run.forward)(run, y);
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) (this->*run->backward)(*run, y);
}

}  // namespace mbs::compiled_ldl
