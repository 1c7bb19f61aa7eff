// Each kind of output from one state.
#include "run/output_values.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "run/constraint_force.hpp"
#include "scene/output_columns.hpp"

namespace mbs {

OutputValues::OutputValues(const Scene& scene) : scene_(scene), motion_(scene) {
  for (const Output& output : scene.elements.outputs) {
    for (const std::string& column : columns_of(output, scene.model.dimension())) {
      columns_.push_back(column);
    }
  }
  angles_.resize(scene.elements.outputs.size(), 0.0);
  has_angles_ = std::ranges::any_of(
      scene.elements.outputs, [](const Output& one) { return one.kind == Output::Kind::angle; });
}

void OutputValues::follow(double t, const State& state) {
  state_ = &state;
  motion_.set(t, state);
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    const Output& output = scene_.elements.outputs[i];
    if (output.kind != Output::Kind::angle) continue;
    const double now = angle(output);
    // The multiple of 2 pi that brings it closest to the last one.
    angles_[i] += std::remainder(now - angles_[i], 2 * std::numbers::pi);
  }
}

std::vector<double> OutputValues::values() const {
  std::vector<double> result(columns_.size());
  values(result);
  return result;
}

void OutputValues::values(std::span<double> result) const {
  auto place = result.begin();
  const auto dimension = static_cast<std::size_t>(scene_.model.dimension());
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    const Output& output = scene_.elements.outputs[i];
    if (vector_prefix(output) == nullptr) {
      *place++ = scalar(i);
      continue;
    }
    const Vector3 value = vector(output);
    for (std::size_t axis = 0; axis < dimension; ++axis) *place++ = value[axis];
  }
}

Vector3 OutputValues::vector(const Output& output) const {
  switch (output.kind) {
    case Output::Kind::position:
      return motion_.position(output.point);
    case Output::Kind::velocity:
      return motion_.velocity(output.point);
    case Output::Kind::acceleration:
      return motion_.acceleration(output.point);
    case Output::Kind::constraint_force:
      return constraint_vector(scene_, motion_, *state_, output);
    case Output::Kind::angle:
    case Output::Kind::distance:
    case Output::Kind::kinetic_energy:
    case Output::Kind::potential_energy:
    case Output::Kind::total_energy:
      break;
  }
  throw std::logic_error("an output that is no vector");
}

double OutputValues::scalar(std::size_t index) const {
  const Output& output = scene_.elements.outputs[index];
  switch (output.kind) {
    case Output::Kind::angle:
      return angles_[index];
    case Output::Kind::distance: {
      const Vector3 d = along(output.first);
      return std::hypot(d[0], d[1], d[2]);
    }
    case Output::Kind::kinetic_energy:
      return motion_.kinetic_energy();
    case Output::Kind::potential_energy:
      return motion_.potential_energy();
    case Output::Kind::total_energy:
      return motion_.kinetic_energy() + motion_.potential_energy();
    case Output::Kind::constraint_force:
      return constraint_scalar(scene_, motion_, *state_, output);
    case Output::Kind::position:
    case Output::Kind::velocity:
    case Output::Kind::acceleration:
      break;
  }
  throw std::logic_error("an output that is no single number");
}

Vector3 OutputValues::along(const Direction& direction) const {
  const Vector3 to = motion_.position(direction.to);
  return direction.from < 0 ? to : to - motion_.position(direction.from);
}

double OutputValues::angle(const Output& output) const {
  const Vector3 u = along(output.first), w = along(output.second);
  Vector3 z = output.axis < 0 ? Vector3{0.0, 0.0, 1.0} : motion_.position(output.axis);
  z = (1.0 / norm(z)) * z;
  return std::atan2(dot(z, cross(u, w)), dot(u, w) - dot(z, u) * dot(z, w));  // across z
}

}  // namespace mbs
