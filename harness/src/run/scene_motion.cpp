// Entries of the state, values of drivers, and sums of both.
#include "run/scene_motion.hpp"

#include <algorithm>

#include "model_math/kinematics.hpp"

namespace mbs {

SceneMotion::SceneMotion(const Scene& scene) : scene_(scene), known_(scene.model, 0.0) {}

void SceneMotion::set(double t, const State& state) {
  known_.set_time(t);
  t_ = t;
  state_ = &state;
}

int SceneMotion::points() const {
  return static_cast<int>(scene_.model.points().size() + scene_.elements.markers.size());
}

const std::string& SceneMotion::name(int index) const {
  const auto i = static_cast<std::size_t>(index);
  const auto points = scene_.model.points();
  return i < points.size() ? points[i].name : scene_.elements.markers[i - points.size()].name;
}

template <class Known>
Vector3 SceneMotion::motion(int index, const std::vector<double> State::*free, Known known) const {
  const auto i = static_cast<std::size_t>(index);
  const auto points = scene_.model.points();
  Vector3 result{};
  if (i >= points.size()) {
    for (const Marker::Part& part : scene_.elements.markers[i - points.size()].parts) {
      result = result + multiply(part.matrix, motion(part.point, free, known));
    }
  } else if (points[i].is_fixed()) {
    result = known(index);
  } else {
    std::copy_n((state_->*free).begin() + points[i].offset, scene_.model.dimension(),
                result.begin());
  }
  return result;
}

Vector3 SceneMotion::position(int index) const {
  return motion(index, &State::q, [this](int point) { return known_.position(point); });
}
Vector3 SceneMotion::velocity(int index) const {
  return motion(index, &State::v, [this](int point) { return known_.velocity(point); });
}
Vector3 SceneMotion::acceleration(int index) const {
  return motion(index, &State::a, [this](int point) { return known_.acceleration(point); });
}

double SceneMotion::kinetic_energy() const {
  const Model& model = scene_.model;
  const auto rate = [this](int point, int axis) {
    return known_.velocity(point)[static_cast<std::size_t>(axis)];
  };
  double result = mbs::kinetic_energy(model, state_->v);
  for (const DrivenMass& mass : model.driven_mass()) {
    result += mass.value * state_->v[static_cast<std::size_t>(mass.coordinate)] *
              rate(mass.point, mass.axis);
  }
  for (const auto& mass : scene_.elements.driven_energy.masses) {
    result += mass.value * rate(mass.a, mass.axis_a) * rate(mass.b, mass.axis_b);
  }
  return result;
}

double SceneMotion::potential_energy() const {
  double result = mbs::potential_energy(scene_.model, t_, state_->q);
  for (const auto& [point, force] : scene_.elements.driven_energy.forces) {
    result -= dot(force, known_.position(point));
  }
  for (const std::size_t index : scene_.elements.driven_springs) {
    const ForceLaw& spring = scene_.model.force_laws()[index];
    const double free = spring.law.by_position.pieces.front().origin;
    const double stretch = norm(position(spring.a) - position(spring.b)) - free;
    result += spring.law.factor.at(t_).value / 2 * stretch * stretch;
  }
  return result;
}

}  // namespace mbs
