// Springs, torsion springs, laws and torques.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "printable.hpp"
#include "scene/lowering.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr double kPerpendicular = 1e-6;  // largest cosine of a right angle

Vector3 difference(const ModelData& data, int a, int b) {
  return data.points[static_cast<std::size_t>(a)].position -
         data.points[static_cast<std::size_t>(b)].position;
}

/// z, in space the unit vector `axis`, which the direction must be perpendicular to.
Vector3 axis_of(const ModelData& data, int axis, const Vector3& direction, const std::string& name,
                const std::string& where) {
  if (axis < 0) return {0.0, 0.0, 1.0};
  const Point& point = data.points[static_cast<std::size_t>(axis)];
  const Vector3 z = point.position;
  const double along = dot(z, direction);
  if (std::abs(along) <= kPerpendicular * std::hypot(direction[0], direction[1], direction[2])) {
    return z;
  }
  throw UsageError(fmt::format(
      "{}: {}: found a direction that is not perpendicular to the axis {} at the start (its part "
      "along it is {:.3g}), allowed is a direction that stays perpendicular to its axis",
      printable(where), name, in_quotes(point.name), along));
}

}  // namespace

void Lowering::lower_forces() {
  for (const DraftSpring& spring : draft_.springs) lower_spring(spring);
  for (const DraftTorsionSpring& spring : draft_.torsion_springs) lower_torsion_spring(spring);
  for (const DraftForceLaw& law : draft_.force_laws) lower_force_law(law);
  for (const DraftTorqueLaw& law : draft_.torque_laws) lower_torque_law(law);
  for (const DraftTorque& torque : draft_.torques) lower_torque(torque);
}

void Lowering::lower_spring(const DraftSpring& spring) {
  if (!spring.length) lowered_.relaxed_springs.push_back(model().springs.size());
  model().springs.push_back({index(spring.a), index(spring.b), spring.stiffness, spring.damping,
                             spring.length.value_or(0.0), spring.name});
}

void Lowering::lower_torsion_spring(const DraftTorsionSpring& spring) {
  if (spring.angle && std::abs(*spring.angle) > std::numbers::pi) {
    spring.node.get("angle").fail("an angle in rad of -pi to pi");
  }
  if (!spring.angle) lowered_.relaxed_torsion_springs.push_back(model().torsion_springs.size());
  const Edge from = edge(spring.from), to = edge(spring.to);
  model().torsion_springs.push_back({from.a, from.b, to.a, to.b,
                                     spring.axis < 0 ? -1 : index(spring.axis), spring.stiffness,
                                     spring.damping, spring.angle.value_or(0.0), spring.name});
}

void Lowering::lower_force_law(const DraftForceLaw& law) {
  model().force_laws.push_back({index(law.a), index(law.b), law.law, law.name});
}

void Lowering::lower_torque_law(const DraftTorqueLaw& law) {
  const Edge from = edge(law.from), to = edge(law.to);
  model().torque_laws.push_back(
      {from.a, from.b, to.a, to.b, law.axis < 0 ? -1 : index(law.axis), law.law, law.name});
}

void Lowering::lower_torque(const DraftTorque& torque) {
  Edge turned;
  if (torque.body >= 0 && torque.direction.to < 0) {
    const DraftBody& body = draft_.body(torque.body);
    turned = {index(body.items[body.basis[1]].point), index(body.items[body.basis[0]].point)};
  } else {
    turned = edge(torque.direction);
  }
  model().couples.push_back(
      {turned.a, turned.b, torque.axis < 0 ? -1 : index(torque.axis), torque.torque, torque.name});
}

void finish_start(Lowered& lowered, const std::string& where) {
  ModelData& data = lowered.data.model;
  for (const std::size_t i : lowered.relaxed_springs) {
    const Vector3 d = difference(data, data.springs[i].a, data.springs[i].b);
    data.springs[i].length = std::hypot(d[0], d[1], d[2]);
  }
  for (const std::size_t i : lowered.relaxed_torsion_springs) {
    TorsionSpring& s = data.torsion_springs[i];
    const Vector3 u = difference(data, s.a, s.b), w = difference(data, s.c, s.d);
    s.angle = std::atan2(dot(axis_of(data, s.axis, w, s.name, where), cross(u, w)), dot(u, w));
  }
  const auto require_across = [&](const auto& corner) {
    axis_of(data, corner.axis, difference(data, corner.a, corner.b), corner.name, where);
    axis_of(data, corner.axis, difference(data, corner.c, corner.d), corner.name, where);
  };
  std::ranges::for_each(data.torsion_springs, require_across);
  std::ranges::for_each(data.torque_laws, require_across);
  for (const Couple& couple : data.couples) {
    axis_of(data, couple.axis, difference(data, couple.a, couple.b), couple.name, where);
  }
}

}  // namespace mbs
