// The harness's own evaluation of a state; no implementation contributes to it.
#include "run/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model_math/kinematics.hpp"

namespace mbs {
namespace {

/// Largest distance along one axis that the scene spans at t = 0, m.
double extent(const Model& model) {
  double largest = 0.0;
  for (int axis = 0; axis < model.dimension(); ++axis) {
    const auto at = [axis](const Point& point) { return point.position[axis]; };
    const auto [low, high] = std::ranges::minmax_element(model.points(), {}, at);
    largest = std::max(largest, at(*high) - at(*low));
  }
  return largest;
}

/// What each constraint's |Phi| is small against: the squared length, or the extent if linear.
std::vector<double> constraint_scales(const Model& model) {
  std::vector<double> scales;
  const auto points = model.points();
  for (const DotConstraint& c : model.dot_constraints()) {
    double first = 0.0, second = 0.0;
    for (int axis = 0; axis < model.dimension(); ++axis) {
      first = std::hypot(first, points[c.a].position[axis] - points[c.b].position[axis]);
      second = std::hypot(second, points[c.c].position[axis] - points[c.d].position[axis]);
    }
    scales.push_back(std::max(std::abs(c.value), first * second));
  }
  scales.resize(static_cast<std::size_t>(model.constraints()), extent(model));
  return scales;
}

bool is_finite(const State& state) {
  const auto finite = [](const std::vector<double>& values) {
    return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
  };
  return finite(state.q) && finite(state.v) && finite(state.a) && finite(state.lambda);
}

}  // namespace

Judge::Judge(const Scene& scene, const State& initial, double start)
    : scene_(scene),
      phi_(static_cast<std::size_t>(scene.model.constraints())),
      phi_scale_(constraint_scales(scene.model)),
      initial_energy_(energy(scene.model, initial.q, initial.v)) {
  double force = 0.0;
  for (const double component : scene.model.force()) force += std::abs(component);
  energy_scale_ = 1e-3 * force * extent(scene.model);
  if (scene.four_bar_loops) {
    exact_.emplace(*scene.four_bar_loops);
    position_error_ = 0.0;
  }
  judge(start, initial);
}

std::string Judge::judge(double t, const State& state) {
  if (!is_finite(state)) {
    violation_ = energy_difference_ = std::numeric_limits<double>::infinity();
    if (exact_) position_error_ = std::numeric_limits<double>::infinity();
    return "the state is not finite";
  }
  const Model& model = scene_.model;
  evaluate_constraints(model, state.q, phi_);
  double relative = 0.0;
  for (std::size_t k = 0; k < phi_.size(); ++k) {
    violation_ = std::max(violation_, std::abs(phi_[k]));
    relative = std::max(relative, std::abs(phi_[k]) / phi_scale_[k]);
  }
  const double kinetic = kinetic_energy(model, state.v);
  const double difference = std::abs(energy(model, state.q, state.v) - initial_energy_);
  // max() would drop a NaN that finite but huge coordinates make.
  if (!std::isfinite(kinetic) || !std::isfinite(difference) ||
      !std::ranges::all_of(phi_, [](double x) { return std::isfinite(x); })) {
    violation_ = energy_difference_ = std::numeric_limits<double>::infinity();
    return "the state is too large to be judged";
  }
  energy_scale_ = std::max(energy_scale_, kinetic);
  energy_difference_ = std::max(energy_difference_, difference);
  if (exact_) {
    const double error = exact_->position_error(t, state.q);
    position_error_ = std::max(*position_error_, error);
    if (!(error <= bounds_.position_error)) {
      return fmt::format("position error {:.2e} m against the exact solution (allowed {:g})", error,
                         bounds_.position_error);
    }
  }
  if (!(relative <= bounds_.constraint_violation)) {
    return fmt::format("constraints violated by {:.2e} of their size (allowed {:g})", relative,
                       bounds_.constraint_violation);
  }
  if (!(energy_drift_max() <= bounds_.energy_drift)) {
    return fmt::format("energy drifted by {:.2e} of its scale (allowed {:g})", energy_drift_max(),
                       bounds_.energy_drift);
  }
  return "";
}

double Judge::energy_drift_max() const {
  return energy_scale_ > 0.0 ? energy_difference_ / energy_scale_ : energy_difference_;
}

}  // namespace mbs
