// Constraints by type (angles are in lower_angles.cpp); a side that is fixed makes a linear row.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "printable.hpp"
#include "scene/lowering.hpp"
#include "scene/time_functions.hpp"

namespace mbs {
namespace {

using Type = DraftConstraint::Type;

double norm_of(const std::vector<DraftConstraint::Term>& terms) {
  double norm = 0.0;
  for (const DraftConstraint::Term& term : terms) norm = std::hypot(norm, term.coefficient);
  return norm;
}

}  // namespace

void Lowering::lower_constraint(const DraftConstraint& constraint) {
  const std::size_t dots = model().dot_constraints.size();
  const std::size_t bilinears = model().bilinear_constraints.size();
  const std::size_t linears = model().linear_constraints.size();
  switch (constraint.type) {
    case Type::distance:
      lower_distance(constraint);
      break;
    case Type::angle:
      lower_angle(constraint);
      break;
    case Type::perpendicular:
      lower_perpendicular(constraint);
      break;
    case Type::coincident:
      lower_coincident(constraint);
      break;
    case Type::on_line:
      lower_on_line(constraint);
      break;
    case Type::dot:
      lower_dot(constraint);
      break;
    case Type::linear:
      lower_linear(constraint);
      break;
  }
  std::vector<Row> rows;
  const auto add = [&rows](Row::Kind kind, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) rows.push_back({kind, i});
  };
  add(Row::Kind::dot, dots, model().dot_constraints.size());
  add(Row::Kind::bilinear, bilinears, model().bilinear_constraints.size());
  add(Row::Kind::linear, linears, model().linear_constraints.size());
  remember(constraint.node, force_of(constraint, std::move(rows)));
}

Lowering::Force Lowering::force_of(const DraftConstraint& constraint, std::vector<Row> rows) {
  switch (constraint.type) {
    case Type::distance:
      return {Output::Force::tension, std::move(rows)};
    case Type::angle:
    case Type::perpendicular:
      return {Output::Force::torque, std::move(rows), constraint.first, constraint.second};
    case Type::coincident:
    case Type::on_line:
      return {Output::Force::vector, std::move(rows), {constraint.points[1], constraint.points[0]}};
    case Type::dot:
      break;
    case Type::linear:  // of Phi as given: its row is divided by this
      return {Output::Force::multiplier, std::move(rows), {}, {}, 1.0 / norm_of(constraint.terms)};
  }
  return {Output::Force::multiplier, std::move(rows)};
}

void Lowering::lower_distance(const DraftConstraint& constraint) {
  const int a = index(constraint.points[0]), b = index(constraint.points[1]);
  const double start = norm(position(constraint.points[0]) - position(constraint.points[1]));
  if (!(start * start > 0.0)) {
    constraint.node.get("between").fail("two points that start at the same place",
                                        "a distance above 0 (or \"coincident\")");
  }
  const TimeFunction length = constraint.value.value_or(start);
  const TimeFunction squared = square_of(length);
  if (!(length.at(0.0).value > 0.0 && squared.at(0.0).value > 0.0)) {
    constraint.node.get("value").fail("a distance in m above 0 (at t = 0)");
  }
  const DraftDirection between{constraint.points[0], constraint.points[1]};
  refuse_same_dot(constraint.node, between, between);
  rows_.dot(constraint.name, {a, b}, {a, b}, squared);
  const auto name = constraint.node.find("name");
  lowered_.data.elements.distances.push_back({name ? name->text() : constraint.name, a, b});
  if (length.is_constant()) lengths_.emplace(std::minmax(a, b), length.at(0.0).value);
}

void Lowering::lower_coincident(const DraftConstraint& constraint) {
  const int a = index(constraint.points[0]), b = index(constraint.points[1]);
  for (int axis = 0; axis < draft_.dimension; ++axis) {
    distinct_linear(constraint.node, fmt::format("{} {}", constraint.name, "xyz"[axis]),
                    {{a, axis, 1.0}, {b, axis, -1.0}}, 0.0);
  }
}

void Lowering::lower_on_line(const DraftConstraint& constraint) {
  const DraftDirection off{constraint.points[1], constraint.points[0]};
  if (draft_.dimension == 2) {
    const DraftDirection line{constraint.points[1], constraint.points[2]};
    const Vector3 direction = along(line);
    const double length = norm(direction);
    if (!(length > 0.0)) {
      constraint.node.get("line").fail("two points that start at the same place",
                                       "a line through two different places");
    }
    refuse_same_dot(constraint.node, off, line);
    if (draft_.is_fixed(line)) {
      const Vector3 normal = (1.0 / length) * Vector3{-direction[1], direction[0], 0.0};
      distinct_linear(constraint.node, constraint.name, fixed_dot(normal, off), 0.0);
    } else {
      rows_.bilinear(constraint.name, edge(off), edge(line), kCrossProduct, 0.0);
    }
    return;
  }
  const DraftDirection line{-1, constraint.direction};
  refuse_same_dot(constraint.node, off, line);
  if (constraint.normals[0] >= 0) {
    for (int k = 0; k < 2; ++k) {
      const DraftDirection normal{-1, constraint.normals[static_cast<std::size_t>(k)]};
      rows_.dot(fmt::format("{} {}", constraint.name, k + 1), edge(normal), edge(off), 0.0);
    }
    return;
  }
  const Vector3 u = along(line);
  const std::size_t least = static_cast<std::size_t>(
      std::min_element(u.begin(), u.end(),
                       [](double x, double y) { return std::abs(x) < std::abs(y); }) -
      u.begin());
  Vector3 unit{};
  unit[least] = 1.0;
  const Vector3 across = cross(u, unit);
  const Vector3 normal = (1.0 / norm(across)) * across;
  distinct_linear(constraint.node, constraint.name + " 1", fixed_dot(normal, off), 0.0);
  distinct_linear(constraint.node, constraint.name + " 2", fixed_dot(cross(u, normal), off), 0.0);
}

void Lowering::lower_dot(const DraftConstraint& constraint) {
  const Vector3 u = along(constraint.first), w = along(constraint.second);
  if (!(dot(u, u) > 0.0 || dot(w, w) > 0.0)) {
    constraint.node.fail("two differences of length 0 at the start", "at most one");
  }
  const Edge first = edge(constraint.first), second = edge(constraint.second);
  refuse_same_dot(constraint.node, constraint.first, constraint.second);
  rows_.dot(constraint.name, first, second, constraint.value.value_or(dot(u, w)));
}

/// To coefficients of length 1, so that what the author multiplied them with changes neither the
/// row's weight in the penalty nor how its violation, then in metres, is judged.
void Lowering::lower_linear(const DraftConstraint& constraint) {
  const double norm = norm_of(constraint.terms);
  double start = 0.0;
  for (const DraftConstraint::Term& term : constraint.terms) {
    start += term.coefficient * position(term.point)[static_cast<std::size_t>(term.axis)];
  }
  std::vector<Part> parts;
  for (const DraftConstraint::Term& term : constraint.terms) {
    parts.push_back({index(term.point), term.axis, term.coefficient / norm});
  }
  distinct_linear(constraint.node, constraint.name, parts,
                  combination({{1.0 / norm, constraint.value.value_or(start)}}));
}

std::vector<RowWriter::Part> Lowering::fixed_dot(const Vector3& fixed,
                                                 const DraftDirection& moving) const {
  std::vector<Part> parts;
  for (int axis = 0; axis < draft_.dimension; ++axis) {
    const double coefficient = fixed[static_cast<std::size_t>(axis)];
    parts.push_back({index(moving.to), axis, coefficient});
    if (moving.from >= 0) parts.push_back({index(moving.from), axis, -coefficient});
  }
  return parts;
}

void Lowering::refuse_same_dot(const JsonNode& node, const DraftDirection& first,
                               const DraftDirection& second) {
  // Orders within and of the pairs change at most the sign.
  std::pair<int, int> x = std::minmax(first.from, first.to);
  std::pair<int, int> y = std::minmax(second.from, second.to);
  if (y < x) std::swap(x, y);
  const auto [same, is_new] =
      dots_.emplace(std::array<int, 4>{x.first, x.second, y.first, y.second}, node.path());
  if (!is_new) {
    node.fail("the same points as in " + same->second,
              "one rod or constraint between the same points, another is redundant");
  }
}

Lowering::Row Lowering::distinct_linear(const JsonNode& node, const std::string& name,
                                        const std::vector<Part>& parts, const TimeFunction& value) {
  const Row row = rows_.linear(name, parts, value);
  const LinearConstraint& written = model().linear_constraints.back();
  const double scale = written.terms.front().coefficient;
  std::vector<std::pair<int, double>> scaled;
  for (const auto& term : written.terms) {
    scaled.emplace_back(term.coordinate, term.coefficient / scale);
  }
  const Known own{node.path(), written.value / scale};
  const auto [same, is_new] = linears_.emplace(std::move(scaled), own);
  if (is_new) return row;
  const Known& other = same->second;
  constexpr double kSame = 1e-12;  // of the value: rounding
  const bool agrees = std::abs(own.value - other.value) <= kSame * std::abs(own.value);
  node.fail("the same coefficients as in " + other.path + " or a multiple" +
                (agrees ? ""
                        : fmt::format(", but the value {:.9g} m where that has {:.9g} m: they "
                                      "contradict each other",
                                      own.value, other.value)),
            agrees ? "one such constraint, another is redundant" : "one such constraint");
}

}  // namespace mbs
