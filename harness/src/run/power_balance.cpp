// Q of the model less Q of a model of what conserves energy.
#include "run/power_balance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model_math/kinematics.hpp"

namespace mbs {
namespace {

/// Without what loses or brings energy; an element that a driver moves is left out whole.
Model conserving_part(const Model& model) {
  ModelData data = model.data();
  const auto is_moved = [&](int point) {
    return point >= 0 && std::ranges::find(model.driven_points(), point, &DrivenPoint::point) !=
                             model.driven_points().end();
  };
  const auto on_line = [&](const auto& element) {
    return is_moved(element.a) || is_moved(element.b);
  };
  const auto about_axis = [&](const auto& element) {
    return on_line(element) || is_moved(element.c) || is_moved(element.d) || is_moved(element.axis);
  };
  const auto loses = [](const Law& law) {
    return !law.by_rate.is_zero() || !law.factor.is_constant();
  };
  std::erase_if(data.springs, on_line);
  std::erase_if(data.torsion_springs, about_axis);
  std::erase_if(data.force_laws,
                [&](const ForceLaw& law) { return on_line(law) || loses(law.law); });
  std::erase_if(data.torque_laws,
                [&](const TorqueLaw& law) { return about_axis(law) || loses(law.law); });
  for (Spring& spring : data.springs) spring.damping = 0.0;
  for (TorsionSpring& spring : data.torsion_springs) spring.damping = 0.0;
  data.couples.clear();
  data.driven_mass.clear();
  return Model(std::move(data));
}

}  // namespace

PowerBalance::PowerBalance(const Scene& scene)
    : model_(scene.model),
      conserving_(conserving_part(scene.model)),
      force_(static_cast<std::size_t>(model_.variables())),
      conserved_(force_.size()),
      rate_(static_cast<std::size_t>(model_.constraints())),
      rest_(force_.size(), 0.0) {}

PowerBalance::Instant PowerBalance::at(double t, const State& state) {
  Instant result;
  result.energy = energy(conserving_, t, state.q, state.v);
  applied_force(model_, t, state.q, state.v, force_);
  applied_force(conserving_, t, state.q, state.v, conserved_);
  constraint_rate(model_, t, state.q, rest_, rate_);  // Phi_t
  for (std::size_t i = 0; i < force_.size(); ++i) {
    result.power += (force_[i] - conserved_[i]) * state.v[i];
  }
  for (std::size_t k = 0; k < rate_.size(); ++k) result.power += state.lambda[k] * rate_[k];
  return result;
}

PowerBalance::Step PowerBalance::over(const State& before, const State& after, double t,
                                      double step) {
  const Instant begin = at(t - step, before), end = at(t, after);
  const double work = step / 2 * (begin.power + end.power);
  return {end.energy - begin.energy - work, std::abs(work)};
}

double PowerBalance::braked(double t, const State& state) {
  applied_force(model_, t, state.q, state.v, force_);
  applied_force(model_, t, state.q, rest_, conserved_);
  double power = 0.0;
  for (std::size_t i = 0; i < force_.size(); ++i) {
    power += (conserved_[i] - force_[i]) * state.v[i];
  }
  const double kinetic = kinetic_energy(model_, state.v);
  return power > 0.0 && kinetic > 0.0 ? power / kinetic : 0.0;
}

}  // namespace mbs
