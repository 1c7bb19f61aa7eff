// Samples the drivers.
#include "model_math/known_motion.hpp"

#include <algorithm>

namespace mbs {

KnownMotion::KnownMotion(const Model& model, double t) : model_(model), time_(t) {
  const std::size_t driven = model.driven_points().size();
  if (driven == 0 && model.driven_values().empty()) return;  // judges make one for each state
  for (auto* motion : {&positions_, &velocities_, &accelerations_}) motion->resize(driven);
  if (driven != 0) driven_.assign(model.points().size(), -1);
  for (std::size_t i = 0; i < driven; ++i) {
    driven_[static_cast<std::size_t>(model.driven_points()[i].point)] = static_cast<int>(i);
  }
  set_time(t);
}

void KnownMotion::set_time(double t) {
  time_ = t;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    for (int axis = 0; axis < model_.dimension(); ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const TimeFunction::Sample sample = model_.driven_points()[i].position[k].at(t);
      positions_[i][k] = sample.value;
      velocities_[i][k] = sample.rate;
      accelerations_[i][k] = sample.acceleration;
    }
  }
  if (!model_.driven_values().empty()) static_cast<void>(values());  // fills them
  for (const DrivenValue& driven : model_.driven_values()) {
    values_[static_cast<std::size_t>(driven.constraint)] = driven.value.at(t);
  }
}

const std::vector<TimeFunction::Sample>& KnownMotion::values() const {
  if (!values_.empty()) return values_;
  values_.resize(static_cast<std::size_t>(model_.constraints()));
  auto place = values_.begin();
  const auto add = [&place](const auto& constraint) { (place++)->value = constraint.value; };
  std::ranges::for_each(model_.dot_constraints(), add);
  std::ranges::for_each(model_.bilinear_constraints(), add);
  std::ranges::for_each(model_.linear_constraints(), add);
  return values_;
}

KnownMotion::Vector KnownMotion::of(int point, const std::vector<Vector>& motion) const {
  const int driven = driven_.empty() ? -1 : driven_[static_cast<std::size_t>(point)];
  return driven < 0 ? Vector{} : motion[static_cast<std::size_t>(driven)];
}

}  // namespace mbs
