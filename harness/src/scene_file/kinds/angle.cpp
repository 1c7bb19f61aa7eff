// Angles: what is fixed, what moves and what is driven decide their rows.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "scene/time_functions.hpp"
#include "scene_file/kinds/drivers.hpp"
#include "scene_file/kinds/joint_parts.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {
namespace {

void read_directions(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  constraint.first = reader.direction(node.get("first"));
  constraint.second = reader.direction(node.get("second"));
  reader.use_between(node, constraint.first, constraint.second);
}

/// Radians; in the plane from first to second, counter-clockwise, in space 0 ... pi.
double start_angle(Lowering& scene, const DraftConstraint& constraint) {
  const Vector3 u = scene.along(constraint.first), w = scene.along(constraint.second);
  for (const auto& [key, length] : {std::pair{"first", norm(u)}, std::pair{"second", norm(w)}}) {
    if (length > 0.0) continue;
    constraint.node.get(key).fail("a direction between points that start at the same place",
                                  "a direction of length above 0");
  }
  const Vector3 product = cross(u, w);
  const double sine = scene.draft().dimension == 2 ? product[2] : norm(product);
  return std::atan2(sine, dot(u, w));
}

double required_length(Lowering& scene, const DraftConstraint& constraint,
                       const DraftDirection& direction, const char* key) {
  const auto length = scene.constant_length(direction);
  if (length && *length > 0.0) return *length;
  constraint.node.get(key).fail("a direction between points whose distance may change",
                                "two points of one rod or body, or a unit vector, for this angle");
}

/// A driven vector of this length at `offset` + `sign` angle(t) from x.
int driven_normal(Lowering& scene, const DraftConstraint& constraint, const TimeFunction& angle,
                  double sign, double offset, double length) {
  const int normal = scene.add_hidden(constraint.node.path() + ".normal", true);
  // sin x = cos(x - pi/2), cos(-x) = cos x
  const TimeFunction x = cosine_of(angle, length, sign * offset);
  const TimeFunction y = cosine_of(angle, length, sign * (offset - std::numbers::pi / 2));
  scene.model().driven_points.push_back({normal, {x, y, 0.0}});
  scene.model().points[static_cast<std::size_t>(normal)].position = {x.at(0.0).value,
                                                                     y.at(0.0).value, 0.0};
  return normal;
}

/// The moving direction stays perpendicular to one at a right angle to where it shall point, which
/// has its length, so that the row weighs like others in m^2.
void lower_fixed_angle(Lowering& scene, const DraftConstraint& constraint,
                       const TimeFunction& angle) {
  const bool is_first_fixed = scene.draft().is_fixed(constraint.first);
  const DraftDirection& fixed = is_first_fixed ? constraint.first : constraint.second;
  const DraftDirection& moving = is_first_fixed ? constraint.second : constraint.first;
  const Vector3 from = scene.along(fixed);
  const double sign = is_first_fixed ? 1.0 : -1.0;
  const double offset = std::atan2(from[1], from[0]) + std::numbers::pi / 2;
  const double length = norm(scene.along(moving));
  if (angle.is_constant()) {
    const double at = offset + sign * angle.at(0.0).value;
    scene.distinct_linear(
        constraint.node, constraint.name,
        scene.fixed_dot({length * std::cos(at), length * std::sin(at), 0.0}, moving), 0.0);
    return;
  }
  const int normal = driven_normal(scene, constraint, angle, sign, offset, length);
  scene.rows().dot(constraint.name, {normal, scene.zero()}, scene.edge(moving), 0.0);
}

void lower_moving_angle(Lowering& scene, const DraftConstraint& constraint,
                        const TimeFunction& angle) {
  const Lowering::Edge first = scene.edge(constraint.first), second = scene.edge(constraint.second);
  if (angle.is_constant()) {  // u turned by the angle is parallel to w: nowhere degenerate
    const double c = std::cos(angle.at(0.0).value), s = std::sin(angle.at(0.0).value);
    const Matrix3 turned{{{-s, c, 0.0}, {-c, -s, 0.0}, {0.0, 0.0, 0.0}}};
    scene.rows().bilinear(constraint.name, first, second, turned, 0.0);
    return;
  }
  // Either row degenerates at some angle, both never do at once.
  const double lengths = required_length(scene, constraint, constraint.first, "first") *
                         required_length(scene, constraint, constraint.second, "second");
  scene.rows().dot(constraint.name + " cos", first, second, cosine_of(angle, lengths));
  scene.rows().bilinear(constraint.name + " sin", first, second, kCrossProduct,
                        cosine_of(angle, lengths, -std::numbers::pi / 2));
}

void lower_planar_angle(Lowering& scene, const DraftConstraint& constraint, double start,
                        const TimeFunction& angle) {
  const double off = std::remainder(start - angle.at(0.0).value, 2 * std::numbers::pi);
  if (std::abs(off) > std::numbers::pi / 2) {
    constraint.node.fail(
        fmt::format("an angle of {:.4g} rad at the start", start),
        fmt::format("one within a quarter turn of its value, {:.4g} rad", angle.at(0.0).value));
  }
  if (scene.draft().is_fixed(constraint.first) || scene.draft().is_fixed(constraint.second)) {
    lower_fixed_angle(scene, constraint, angle);
  } else {
    lower_moving_angle(scene, constraint, angle);
  }
}

void lower_spatial_angle(Lowering& scene, const DraftConstraint& constraint,
                         const TimeFunction& angle) {
  constexpr double kLeast = kLeastSpatialAngle;
  const double start = angle.at(0.0).value;
  if (!(start >= kLeast && start <= std::numbers::pi - kLeast)) {
    constraint.node.fail(
        fmt::format("an angle of {:.4g} rad", start),
        fmt::format("{} to pi - {} rad in space, where its cosine holds it (for parallel "
                    "directions share a unit vector)",
                    kLeast, kLeast));
  }
  const double first = required_length(scene, constraint, constraint.first, "first");
  const double second = required_length(scene, constraint, constraint.second, "second");
  if (scene.draft().is_fixed(constraint.first)) {
    const Vector3 fixed = (second / first) * scene.along(constraint.first);
    scene.distinct_linear(constraint.node, constraint.name,
                          scene.fixed_dot(fixed, constraint.second),
                          cosine_of(angle, second * second));
  } else if (scene.draft().is_fixed(constraint.second)) {
    const Vector3 fixed = (first / second) * scene.along(constraint.second);
    scene.distinct_linear(constraint.node, constraint.name,
                          scene.fixed_dot(fixed, constraint.first),
                          cosine_of(angle, first * first));
  } else {
    scene.rows().dot(constraint.name, scene.edge(constraint.first), scene.edge(constraint.second),
                     cosine_of(angle, first * second));
  }
}

}  // namespace

void write_kept_angle_row(Lowering& scene, const DraftConstraint& constraint) {
  scene.refuse_same_dot(constraint.node, constraint.first, constraint.second);
  const double start = start_angle(scene, constraint);
  lower_planar_angle(scene, constraint, start, start);
}

void write_perpendicular_row(Lowering& scene, const DraftConstraint& constraint,
                             const std::string& name, const DraftDirection& first,
                             const DraftDirection& second) {
  scene.refuse_same_dot(constraint.node, first, second);
  const Vector3 u = scene.along(first), w = scene.along(second);
  if (scene.draft().is_fixed(first)) {
    scene.distinct_linear(constraint.node, name,
                          scene.fixed_dot((norm(w) / norm(u)) * u, second), 0.0);
  } else if (scene.draft().is_fixed(second)) {
    scene.distinct_linear(constraint.node, name,
                          scene.fixed_dot((norm(u) / norm(w)) * w, first), 0.0);
  } else {
    scene.rows().dot(name, scene.edge(first), scene.edge(second), 0.0);
  }
}

void read_angle(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  node.allow_keys({"type", "name", "first", "second", "value"});
  read_directions(reader, node, constraint);
  Driver driver;
  driver.largest_change = 2 * std::numbers::pi / kStepsPerPeriod;
  if (reader.is_spatial()) {
    driver.least = kLeastSpatialAngle;
    driver.most = std::numbers::pi - kLeastSpatialAngle;
    driver.range = fmt::format("{0} to pi - {0} rad", kLeastSpatialAngle);
  }
  read_value(reader, constraint, "in rad", driver);
}

Lowering::Force lower_angle(Lowering& scene, const DraftConstraint& constraint) {
  const double start = start_angle(scene, constraint);
  const TimeFunction angle = constraint.value.value_or(start);
  scene.refuse_same_dot(constraint.node, constraint.first, constraint.second);
  if (scene.draft().dimension == 3) {
    lower_spatial_angle(scene, constraint, angle);
  } else {
    lower_planar_angle(scene, constraint, start, angle);
  }
  return {Output::Force::torque, {}, constraint.first, constraint.second};
}

void read_perpendicular(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  node.allow_keys({"type", "name", "first", "second"});
  read_directions(reader, node, constraint);
}

Lowering::Force lower_perpendicular(Lowering& scene, const DraftConstraint& constraint) {
  static_cast<void>(start_angle(scene, constraint));
  write_perpendicular_row(scene, constraint, constraint.name, constraint.first, constraint.second);
  return {Output::Force::torque, {}, constraint.first, constraint.second};
}

}  // namespace mbs
