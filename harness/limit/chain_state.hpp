// The chain's constants, its state in and out, and the order of its sweeps.
#pragma once

#include <algorithm>
#include <cmath>

#include "limit/chain_passes.hpp"
#include "limit/chain_projections.hpp"

namespace mbs::limit {

template <class V>
Chain<V>::Chain(int loops, const StepSettings& settings)
    : loops_(loops),
      max_passes_(settings.max_passes),
      depth_(static_cast<std::size_t>(loops + 1) / 2),
      s_(settings.step * std::sqrt(6.0 * settings.penalty)),
      h_(settings.step),
      tolerance_(2.0 * s_ * settings.tolerance),
      blocks_(depth_ + 1),
      factors_(depth_ + 1) {
  constexpr double kGravity = 9.81;              // m/s^2
  set_constants(3.0 * s_ * h_ * h_ * kGravity);  // of 1 kg
}

template <class V>
void Chain<V>::set_constants(double weight) {
  struct One {
    double mass, weight;
  };
  // Half of each rod's mass hangs at either end: three rods inside, two at the ends.
  const One inside{6.0, 1.5 * weight}, end{4.0, weight}, nothing{6.0, 0.0};
  const auto place = [](const One& left, const One& right) {
    return Place<V>{make<V>(left.mass, right.mass), make<V>(left.weight, right.weight)};
  };
  first_ = place(end, padded() ? nothing : end);
  second_ = place(inside, padded() ? end : inside);
  interior_ = place(inside, inside);
  middle_ = loops_ == 1 ? place(end, end) : interior_;
  constants_ = {make<V>(1.0, padded() ? 0.0 : 1.0), make<V>(s_ * s_, s_ * s_), make<V>(s_, -s_),
                make<V>(0.5, 0.5)};
}

template <class V>
typename Chain<V>::Seat Chain<V>::seat(int j) const {
  const auto index = static_cast<std::size_t>(j);
  if (index <= depth_) return {index, 0};
  return {static_cast<std::size_t>(loops_ - j + (padded() ? 1 : 0)), 1};
}

template <class V>
void Chain<V>::set(V Block<V>::*field, Seat seat, double value) {
  V& pair = blocks_[seat.block].*field;
  set_lane(pair, seat.lane, value);
  if (seat.block == depth_) set_lane(pair, 1, value);
}

template <class V>
void Chain<V>::set_state(const State& state) {
  std::fill(blocks_.begin(), blocks_.end(), Block<V>{});
  set_lane(blocks_[0].y, 1, s_);  // a block that is not there stands upright
  const double to_w = s_ * h_, to_u = s_ * h_ * h_ / 2.0, to_force = 6.0 * h_ * h_;
  for (int j = 0; j <= loops_; ++j) {
    const auto at = static_cast<std::size_t>(2 * j);
    set(&Block<V>::x, seat(j), s_ * (state.q[at] - j));
    set(&Block<V>::y, seat(j), s_ * state.q[at + 1]);
    set(&Block<V>::wx, seat(j), to_w * state.v[at]);
    set(&Block<V>::wy, seat(j), to_w * state.v[at + 1]);
    set(&Block<V>::ux, seat(j), to_u * state.a[at]);
    set(&Block<V>::uy, seat(j), to_u * state.a[at + 1]);
    const auto row = static_cast<std::size_t>(j);
    set(&Block<V>::rod, seat(j), to_force * state.lambda[row]);
    if (j == 0) continue;
    const Seat coupler = seat(row <= depth_ ? j - 1 : j);  // its outer end
    set_lane(blocks_[coupler.block].coupler, coupler.lane,
             to_force * state.lambda[row + static_cast<std::size_t>(loops_)]);
  }
}

template <class V>
void Chain<V>::get_state(State& state) const {
  const double to_w = s_ * h_, to_u = s_ * h_ * h_ / 2.0, to_force = 6.0 * h_ * h_;
  for (int j = 0; j <= loops_; ++j) {
    const auto at = static_cast<std::size_t>(2 * j);
    const int which = seat(j).lane;
    const Block<V>& block = blocks_[seat(j).block];
    state.q[at] = lane(block.x, which) / s_ + j;
    state.q[at + 1] = lane(block.y, which) / s_;
    state.v[at] = lane(block.wx, which) / to_w;
    state.v[at + 1] = lane(block.wy, which) / to_w;
    state.a[at] = lane(block.ux, which) / to_u;
    state.a[at + 1] = lane(block.uy, which) / to_u;
    const auto row = static_cast<std::size_t>(j);
    state.lambda[row] = lane(block.rod, which) / to_force;
    if (j == 0) continue;
    const Seat coupler = seat(row <= depth_ ? j - 1 : j);
    state.lambda[row + static_cast<std::size_t>(loops_)] =
        lane(blocks_[coupler.block].coupler, coupler.lane) / to_force;
  }
}

template <class V>
StepOutcome Chain<V>::step() {
  pass<true>();
  bool converged = substitute_back();
  int passes = 1;
  for (; !converged && passes < max_passes_; ++passes) {
    pass<false>();
    converged = substitute_back();
  }
  project<VelocitySide<V>>();
  project<AccelerationSide<V>>();
  return {converged ? StepStatus::converged : StepStatus::pass_limit, passes};
}

}  // namespace mbs::limit
