// Springs, torsion springs, forces and torques.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "printable.hpp"
#include "scene/time_functions.hpp"
#include "scene_file/kinds/drivers.hpp"
#include "scene_file/kinds/kinds.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr double kPerpendicular = 1e-6;  // largest cosine of a right angle

double optional_not_negative(const JsonNode& node, std::string_view key, const char* allowed) {
  const auto found = node.find(key);
  return found ? found->number_at_least(0.0, allowed) : 0.0;
}

/// A number of at least 0, or a function of time that stays so; 0 without the key.
TimeFunction not_negative_driver(SceneReader& reader, const JsonNode& node, std::string_view key,
                                 const std::string& allowed) {
  const auto found = node.find(key);
  if (!found) return 0.0;
  if (found->is_number()) return found->number_at_least(0.0, allowed);
  Driver driver;
  driver.least = 0.0;
  driver.range = allowed;
  return read_driver(reader, *found, allowed, std::move(driver));
}

/// What is left of a spring's stiffness or damping when a law has the function.
double constant_part(const TimeFunction& function) {
  return function.is_constant() ? function.at(0.0).value : 0.0;
}

/// 1 N/m from `origin` on: by the factor of a law it is a stiffness, or a damping.
Curve unit_slope(double origin) { return {{}, {{origin, {0.0, 1.0, 0.0, 0.0}}}}; }

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
  spring.stiffness =
      not_negative_driver(reader, node, "stiffness", "a stiffness in N/m of at least 0");
  spring.damping = not_negative_driver(reader, node, "damping", "a damping in N s/m of at least 0");
  if (const auto length = node.find("length")) {
    spring.length = length->number_at_least(0.0, "a length in m of at least 0");
  }
  reader.draft().springs.push_back(std::move(spring));
}

void lower_springs(Lowering& scene) {
  for (const DraftSpring& spring : scene.draft().springs) {
    const int a = scene.index(spring.a), b = scene.index(spring.b);
    const double length = spring.length.value_or(0.0);
    std::vector<ForceLaw>& laws = scene.model().force_laws;
    if (!spring.stiffness.is_constant()) {
      if (!spring.length) scene.lowered().relaxed_force_laws.push_back(laws.size());
      laws.push_back({a, b, {unit_slope(length), {}, spring.stiffness}, spring.name});
    }
    if (!spring.damping.is_constant()) {
      laws.push_back({a, b, {{}, unit_slope(0.0), spring.damping}, spring.name});
    }
    if (!spring.stiffness.is_constant() && !spring.damping.is_constant()) continue;
    if (!spring.length) scene.lowered().relaxed_springs.push_back(scene.model().springs.size());
    scene.model().springs.push_back({a, b, constant_part(spring.stiffness),
                                     constant_part(spring.damping), length, spring.name});
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
  DraftForce force{node, index};
  const JsonNode given = node.get("force");
  const auto axes = given.items();
  const auto dimension = static_cast<std::size_t>(reader.draft().dimension);
  const bool is_driven = std::ranges::any_of(axes, &JsonNode::is_object);
  if (!is_driven || axes.size() != dimension) {
    force.force = reader.coordinates(given);  // or its complaint
  } else {
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      const TimeFunction part = read_driver(reader, axes[axis], "in N");
      if (part.is_constant()) {
        force.force[axis] = part.at(0.0).value;
      } else {
        force.driven[axis] = part;
      }
    }
  }
  reader.draft().forces.push_back(std::move(force));
}

void read_torque(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "direction", "body", "axis", "torque"});
  DraftTorque torque{node, reader.element_name(node)};
  torque.torque = read_driver(reader, node.get("torque"), "in N m");
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

namespace {

/// A law from a fixed direction across the axis, at any angle: -1 N m times the factor turns back.
void lower_driven_torque(Lowering& scene, const DraftTorque& torque, const Lowering::Edge& turned,
                         int axis) {
  Vector3 across{1.0, 0.0, 0.0};
  if (axis >= 0) {
    if (scene.draft().point(torque.axis).hold != Hold::fixed) {
      torque.node.get("torque").fail(
          "a function of time about an axis that moves",
          "a number, a fixed axis, or a torque law between two directions, with a factor");
    }
    across = any_across(scene.position(torque.axis));
  }
  const int from = scene.add_hidden(torque.node.path() + ".from", true);
  scene.model().points[static_cast<std::size_t>(from)].position = across;
  const Curve back{{}, {{0.0, {-1.0, 0.0, 0.0, 0.0}}}};
  scene.model().torque_laws.push_back(
      {from, scene.zero(), turned.a, turned.b, axis, {{}, back, torque.torque}, torque.name});
}

}  // namespace

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
    const int axis = torque.axis < 0 ? -1 : scene.index(torque.axis);
    if (torque.torque.is_constant()) {
      scene.model().couples.push_back(
          {turned.a, turned.b, axis, torque.torque.at(0.0).value, torque.name});
    } else {
      lower_driven_torque(scene, torque, turned, axis);
    }
  }
}

void finish_start(Lowered& lowered, const std::string& where) {
  ModelData& data = lowered.data.model;
  for (const std::size_t i : lowered.relaxed_springs) {
    const Vector3 d = difference(data, data.springs[i].a, data.springs[i].b);
    data.springs[i].length = std::hypot(d[0], d[1], d[2]);
  }
  for (const std::size_t i : lowered.relaxed_force_laws) {
    ForceLaw& law = data.force_laws[i];
    const Vector3 d = difference(data, law.a, law.b);
    law.law.by_position.pieces.front().origin = std::hypot(d[0], d[1], d[2]);
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
