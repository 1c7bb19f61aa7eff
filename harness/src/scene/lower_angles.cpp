// Angles: what is fixed, what moves and what is driven decide their rows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/lowering.hpp"
#include "scene/time_functions.hpp"

namespace mbs {

/// Radians; in the plane from first to second, counter-clockwise, in space 0 ... pi.
double Lowering::start_angle(const DraftConstraint& constraint) const {
  const Vector3 u = along(constraint.first), w = along(constraint.second);
  for (const auto& [key, length] : {std::pair{"first", norm(u)}, std::pair{"second", norm(w)}}) {
    if (length > 0.0) continue;
    constraint.node.get(key).fail("a direction between points that start at the same place",
                                  "a direction of length above 0");
  }
  const Vector3 product = cross(u, w);
  const double sine = draft_.dimension == 2 ? product[2] : norm(product);
  return std::atan2(sine, dot(u, w));
}

void Lowering::lower_angle(const DraftConstraint& constraint) {
  const double start = start_angle(constraint);
  const TimeFunction angle = constraint.value.value_or(start);
  refuse_same_dot(constraint.node, constraint.first, constraint.second);
  if (draft_.dimension == 3) return lower_spatial_angle(constraint, angle);
  const double off = std::remainder(start - angle.at(0.0).value, 2 * std::numbers::pi);
  if (std::abs(off) > std::numbers::pi / 2) {
    constraint.node.fail(
        fmt::format("an angle of {:.4g} rad at the start", start),
        fmt::format("one within a quarter turn of its value, {:.4g} rad", angle.at(0.0).value));
  }
  if (draft_.is_fixed(constraint.first) || draft_.is_fixed(constraint.second)) {
    lower_fixed_angle(constraint, angle);
  } else {
    lower_moving_angle(constraint, angle);
  }
}

/// The moving direction stays perpendicular to one at a right angle to where it shall point, which
/// has its length, so that the row weighs like others in m^2.
void Lowering::lower_fixed_angle(const DraftConstraint& constraint, const TimeFunction& angle) {
  const bool is_first_fixed = draft_.is_fixed(constraint.first);
  const DraftDirection& fixed = is_first_fixed ? constraint.first : constraint.second;
  const DraftDirection& moving = is_first_fixed ? constraint.second : constraint.first;
  const Vector3 from = along(fixed);
  const double sign = is_first_fixed ? 1.0 : -1.0;
  const double offset = std::atan2(from[1], from[0]) + std::numbers::pi / 2;
  const double length = norm(along(moving));
  if (angle.is_constant()) {
    const double at = offset + sign * angle.at(0.0).value;
    distinct_linear(constraint.node, constraint.name,
                    fixed_dot({length * std::cos(at), length * std::sin(at), 0.0}, moving), 0.0);
    return;
  }
  const int normal = driven_normal(constraint, angle, sign, offset, length);
  rows_.dot(constraint.name, {normal, zero()}, edge(moving), 0.0);
}

/// A driven vector of this length at `offset` + `sign` angle(t) from x.
int Lowering::driven_normal(const DraftConstraint& constraint, const TimeFunction& angle,
                            double sign, double offset, double length) {
  const int normal = add_hidden(constraint.node.path() + ".normal", true);
  // sin x = cos(x - pi/2), cos(-x) = cos x
  const TimeFunction x = cosine_of(angle, length, sign * offset);
  const TimeFunction y = cosine_of(angle, length, sign * (offset - std::numbers::pi / 2));
  model().driven_points.push_back({normal, {x, y, 0.0}});
  model().points[static_cast<std::size_t>(normal)].position = {x.at(0.0).value, y.at(0.0).value,
                                                               0.0};
  return normal;
}

void Lowering::lower_moving_angle(const DraftConstraint& constraint, const TimeFunction& angle) {
  const Edge first = edge(constraint.first), second = edge(constraint.second);
  if (angle.is_constant()) {  // u turned by the angle is parallel to w: nowhere degenerate
    const double c = std::cos(angle.at(0.0).value), s = std::sin(angle.at(0.0).value);
    const Matrix3 turned{{{-s, c, 0.0}, {-c, -s, 0.0}, {0.0, 0.0, 0.0}}};
    rows_.bilinear(constraint.name, first, second, turned, 0.0);
    return;
  }
  // Either row degenerates at some angle, both never do at once.
  const double lengths = required_length(constraint, constraint.first, "first") *
                         required_length(constraint, constraint.second, "second");
  rows_.dot(constraint.name + " cos", first, second, cosine_of(angle, lengths));
  rows_.bilinear(constraint.name + " sin", first, second, kCrossProduct,
                 cosine_of(angle, lengths, -std::numbers::pi / 2));
}

void Lowering::lower_spatial_angle(const DraftConstraint& constraint, const TimeFunction& angle) {
  constexpr double kLeast = kLeastSpatialAngle;
  const double start = angle.at(0.0).value;
  if (!(start >= kLeast && start <= std::numbers::pi - kLeast)) {
    constraint.node.fail(
        fmt::format("an angle of {:.4g} rad", start),
        fmt::format("{} to pi - {} rad in space, where its cosine holds it (for parallel "
                    "directions share a unit vector)",
                    kLeast, kLeast));
  }
  const double first = required_length(constraint, constraint.first, "first");
  const double second = required_length(constraint, constraint.second, "second");
  if (draft_.is_fixed(constraint.first)) {
    const Vector3 fixed = (second / first) * along(constraint.first);
    distinct_linear(constraint.node, constraint.name, fixed_dot(fixed, constraint.second),
                    cosine_of(angle, second * second));
  } else if (draft_.is_fixed(constraint.second)) {
    const Vector3 fixed = (first / second) * along(constraint.second);
    distinct_linear(constraint.node, constraint.name, fixed_dot(fixed, constraint.first),
                    cosine_of(angle, first * first));
  } else {
    rows_.dot(constraint.name, edge(constraint.first), edge(constraint.second),
              cosine_of(angle, first * second));
  }
}

void Lowering::lower_perpendicular(const DraftConstraint& constraint) {
  static_cast<void>(start_angle(constraint));
  refuse_same_dot(constraint.node, constraint.first, constraint.second);
  const Vector3 u = along(constraint.first), w = along(constraint.second);
  if (draft_.is_fixed(constraint.first)) {
    distinct_linear(constraint.node, constraint.name,
                    fixed_dot((norm(w) / norm(u)) * u, constraint.second), 0.0);
  } else if (draft_.is_fixed(constraint.second)) {
    distinct_linear(constraint.node, constraint.name,
                    fixed_dot((norm(u) / norm(w)) * w, constraint.first), 0.0);
  } else {
    rows_.dot(constraint.name, edge(constraint.first), edge(constraint.second), 0.0);
  }
}

std::optional<double> Lowering::constant_length(const DraftDirection& direction) const {
  if (direction.from < 0) return 1.0;
  if (draft_.is_fixed(direction)) return norm(along(direction));
  const auto known = lengths_.find(std::minmax({index(direction.from), index(direction.to)}));
  if (known != lengths_.end()) return known->second;
  const int shared = common_body(draft_, {direction.from, direction.to});
  if (shared < 0) return std::nullopt;
  std::array<Vector3, 2> ends{};
  for (const DraftBody::Item& item : draft_.body(shared).items) {
    if (item.point == direction.from) ends[0] = item.local;
    if (item.point == direction.to) ends[1] = item.local;
  }
  return norm(ends[1] - ends[0]);
}

double Lowering::required_length(const DraftConstraint& constraint, const DraftDirection& direction,
                                 const char* key) const {
  const auto length = constant_length(direction);
  if (length && *length > 0.0) return *length;
  constraint.node.get(key).fail("a direction between points whose distance may change",
                                "two points of one rod or body, or a unit vector, for this angle");
}

}  // namespace mbs
