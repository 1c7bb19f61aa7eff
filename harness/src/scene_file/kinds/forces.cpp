// Springs, torsion springs, forces and torques.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "printable.hpp"
#include "scene_file/kinds/kinds.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr double kPerpendicular = 1e-6;  // largest cosine of a right angle

double optional_not_negative(const JsonNode& node, std::string_view key, const char* allowed) {
  const auto found = node.find(key);
  return found ? found->number_at_least(0.0, allowed) : 0.0;
}

/// In the plane the body's two coordinate points take the couple; in space a vector of the body's
/// across the axis does, which must stay across it.
void read_torque_on_body(SceneReader& reader, const JsonNode& node, DraftTorque& torque) {
  torque.body = reader.body(node);
  if (!reader.is_spatial()) return;
  const DraftBody& owner = reader.draft().body(torque.body);
  for (const DraftBody::Item& item : owner.items) {
    if (item.point != torque.axis) continue;
    const Vector3 along = item.local;
    torque.direction = {-1, reader.vector_across(torque.body, along)};
    return;
  }
  torque.node.get("axis").fail(
      "the unit vector " + in_quotes(reader.draft().point(torque.axis).name) +
          ", which is not one of " + in_quotes(owner.name),
      "a unit vector among the body's \"vectors\" (or a direction in place of the body)");
}

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

void read_spring(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "between", "stiffness", "damping", "length"});
  const JsonNode between = node.get("between");
  const auto [a, b] = reader.point_pair(between);
  reader.use_between(between, {a, b});
  DraftSpring spring{node, reader.element_name(node), a, b};
  spring.stiffness = optional_not_negative(node, "stiffness", "a stiffness in N/m of at least 0");
  spring.damping = optional_not_negative(node, "damping", "a damping in N s/m of at least 0");
  if (const auto length = node.find("length")) {
    spring.length = length->number_at_least(0.0, "a length in m of at least 0");
  }
  reader.draft().springs.push_back(std::move(spring));
}

void lower_springs(Lowering& scene) {
  for (const DraftSpring& spring : scene.draft().springs) {
    if (!spring.length) scene.lowered().relaxed_springs.push_back(scene.model().springs.size());
    scene.model().springs.push_back({scene.index(spring.a), scene.index(spring.b), spring.stiffness,
                                     spring.damping, spring.length.value_or(0.0), spring.name});
  }
}

void read_torsion_spring(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "from", "to", "axis", "stiffness", "damping", "angle"});
  DraftTorsionSpring spring{node, reader.element_name(node), reader.direction(node.get("from")),
                            reader.direction(node.get("to"))};
  reader.use_between(node, spring.from, spring.to);
  spring.axis = reader.axis(node);
  spring.stiffness =
      optional_not_negative(node, "stiffness", "a stiffness in N m/rad of at least 0");
  spring.damping = optional_not_negative(node, "damping", "a damping in N m s/rad of at least 0");
  if (const auto angle = node.find("angle")) spring.angle = angle->number();
  reader.draft().torsion_springs.push_back(std::move(spring));
}

void lower_torsion_springs(Lowering& scene) {
  for (const DraftTorsionSpring& spring : scene.draft().torsion_springs) {
    if (spring.angle && std::abs(*spring.angle) > std::numbers::pi) {
      spring.node.get("angle").fail("an angle in rad of -pi to pi");
    }
    auto& springs = scene.model().torsion_springs;
    if (!spring.angle) scene.lowered().relaxed_torsion_springs.push_back(springs.size());
    const Lowering::Edge from = scene.edge(spring.from), to = scene.edge(spring.to);
    springs.push_back({from.a, from.b, to.a, to.b, spring.axis < 0 ? -1 : scene.index(spring.axis),
                       spring.stiffness, spring.damping, spring.angle.value_or(0.0), spring.name});
  }
}

void read_force(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "point", "force"});
  static_cast<void>(reader.element_name(node));
  const JsonNode at = node.get("point");
  const int index = reader.point(at);
  if (reader.draft().point(index).hold != Hold::free) {
    at.fail("the fixed or driven point " + in_quotes(at.text()),
            "a free point (a force there has no effect)");
  }
  reader.draft().point(index).is_loaded = true;
  reader.draft().forces.push_back({node, index, reader.coordinates(node.get("force"))});
}

void read_torque(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "direction", "body", "axis", "torque"});
  DraftTorque torque{node, reader.element_name(node)};
  torque.torque = node.get("torque").number();
  torque.axis = reader.axis(node);
  if (node.find("body")) {
    if (const auto other = node.find("direction")) {
      other->fail("a direction beside a body", "one of the two");
    }
    read_torque_on_body(reader, node.get("body"), torque);
  } else {
    const JsonNode turned = node.get("direction");
    torque.direction = reader.direction(turned);
    reader.use(torque.direction);
    if (!reader.draft().is_free(torque.direction)) {
      turned.fail("a fixed or driven direction", "one that a torque can turn");
    }
  }
  reader.draft().torques.push_back(std::move(torque));
}

void lower_torques(Lowering& scene) {
  for (const DraftTorque& torque : scene.draft().torques) {
    Lowering::Edge turned;
    if (torque.body >= 0 && torque.direction.to < 0) {
      const DraftBody& body = scene.draft().body(torque.body);
      turned = {scene.index(body.items[body.basis[1]].point),
                scene.index(body.items[body.basis[0]].point)};
    } else {
      turned = scene.edge(torque.direction);
    }
    scene.model().couples.push_back({turned.a, turned.b,
                                     torque.axis < 0 ? -1 : scene.index(torque.axis), torque.torque,
                                     torque.name});
  }
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
