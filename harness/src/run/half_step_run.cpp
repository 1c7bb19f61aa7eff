// Positions at the steps that both simulations share.
#include "run/half_step_run.hpp"

#include <cmath>
#include <limits>

#include "run/scene_distance.hpp"

namespace mbs {

double richardson_factor(Scheme scheme) {
  const bool is_sixth = scheme == Scheme::rattle6 || scheme == Scheme::multistep6;
  const int order = scheme == Scheme::rattle4 ? 4 : is_sixth ? 6 : 2;
  return 1.0 / (1.0 - std::ldexp(1.0, -order));
}

HalfStepRun::HalfStepRun(const Scene& scene, const StepAgain::Create& create,
                         const StepSettings& half, const State& initial, double length)
    : scene_(scene),
      simulation_(create(half)),
      state_(initial),
      length_(length),
      lengths_(lengths_of_points(scene, length)),
      links_(short_links(scene.model, length)),
      factor_(richardson_factor(half.scheme)) {
  simulation_->set_state(initial);
}

void HalfStepRun::advance() {
  for (int i = 0; i < 2; ++i) {
    if (simulation_->step().status == StepStatus::factorization_failed) {
      error_ = share_ = std::numeric_limits<double>::infinity();
    }
  }
}

void HalfStepRun::compare(const State& whole) {
  simulation_->get_state(state_);
  const auto keep_larger = [](double& largest, double value) {  // a NaN is infinite
    if (!(value <= largest)) largest = std::isnan(value) ? HUGE_VAL : value;
  };
  double distance = 0.0, share = 0.0;  // squared
  auto length = lengths_.begin();
  const auto see = [&](const Vector3& off) {
    const double squared = dot(off, off), its = *length++;
    keep_larger(distance, squared);
    keep_larger(share, squared / (its * its));
  };
  const auto off = [&](std::size_t i) { return whole.q[i] - state_.q[i]; };
  for_each_point(scene_, length_, see, off);
  auto link = links_.begin();
  const auto see_link = [&](const Vector3& apart) {
    const double its = (link++)->length;
    keep_larger(share, dot(apart, apart) / (its * its));
  };
  for_each_link(scene_.model, links_, see_link, off);
  keep_larger(error_, factor_ * std::sqrt(distance));
  keep_larger(share_, factor_ * std::sqrt(share));
}

}  // namespace mbs
