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
    if (value <= largest) return false;
    largest = std::isnan(value) ? HUGE_VAL : value;
    return true;
  };
  double distance = 0.0, share = 0.0;  // squared
  std::size_t place = 0, farthest = 0;
  const auto see_share = [&](double squared, double length) {
    if (keep_larger(share, squared / (length * length))) farthest = place;
    ++place;
  };
  const auto see = [&](const Vector3& off) {
    const double squared = dot(off, off);
    keep_larger(distance, squared);
    see_share(squared, lengths_[place]);
  };
  const auto off = [&](std::size_t i) { return whole.q[i] - state_.q[i]; };
  for_each_point(scene_, length_, see, off);
  const auto see_link = [&](const Vector3& apart) {
    see_share(dot(apart, apart), links_[place - lengths_.size()].length);
  };
  for_each_link(scene_.model, links_, see_link, off);
  keep_larger(error_, factor_ * std::sqrt(distance));
  if (keep_larger(share_, factor_ * std::sqrt(share))) worst_ = farthest;
}

std::string HalfStepRun::farthest_off() const {
  std::vector<std::string> names;
  for (const Point& point : scene_.model.points()) {
    if (!point.is_fixed()) names.push_back(point.name);
  }
  for (const Marker& marker : scene_.elements.markers) names.push_back(marker.name);
  for (const ShortLink& link : links_) names.push_back(link.distance->name);
  return names[worst_];
}

}  // namespace mbs
