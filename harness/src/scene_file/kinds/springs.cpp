// Springs and torsion springs; what the start decides of them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "printable.hpp"
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

/// A number of at least 0, or a function of time that is so at the start and in a run; 0 without
/// the key. `name` is the spring's.
TimeFunction not_negative_driver(SceneReader& reader, const JsonNode& node, std::string_view key,
                                 const std::string& name, const std::string& allowed) {
  const auto found = node.find(key);
  if (!found) return 0.0;
  if (found->is_number()) return found->number_at_least(0.0, allowed);
  Driver driver;
  driver.least = 0.0;
  driver.range = allowed;
  driver.name = name;
  TimeFunction value = read_driver(reader, *found, allowed, std::move(driver));
  if (const double first = value.at(0.0).value; first < 0.0) {
    const char* when = value.is_constant() ? "at all times" : "at t = 0 s";
    found->fail(fmt::format("a value of {} of {:g} {}", name, first, when), allowed);
  }
  return value;
}

/// What is left of a spring's stiffness or damping when a law has the function.
double constant_part(const TimeFunction& function) {
  return function.is_constant() ? function.at(0.0).value : 0.0;
}

/// 1 N/m from `origin` on: by the factor of a law it is a stiffness, or a damping.
Curve unit_slope(double origin) { return {{}, {{origin, {0.0, 1.0, 0.0, 0.0}}}}; }

Vector3 difference(const ModelData& data, int a, int b) {
  return data.points[static_cast<std::size_t>(a)].position -
         data.points[static_cast<std::size_t>(b)].position;
}

/// z, in space the unit vector `axis`, which the direction must be perpendicular to.
Vector3 axis_of(const ModelData& data, int axis, const Vector3& direction, const std::string& name,
                const std::string& where) {
  if (!(dot(direction, direction) > 0.0)) {
    throw UsageError(fmt::format("{}: {}: found a direction between points that start at the same "
                                 "place, allowed is a direction of length above 0",
                                 printable(where), name));
  }
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
  spring.stiffness = not_negative_driver(reader, node, "stiffness", spring.name,
                                         "a stiffness in N/m of at least 0");
  spring.damping =
      not_negative_driver(reader, node, "damping", spring.name, "a damping in N s/m of at least 0");
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
      scene.elements().driven_springs.push_back(laws.size());
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
