// Constraints by type.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "printable.hpp"
#include "scene/scene_reader.hpp"

namespace mbs {
namespace {

using Type = DraftConstraint::Type;

constexpr std::size_t kMostTerms = 10'000;
constexpr std::string_view kAxes = "xyz";
constexpr double kAcross = 1e-12;  // cosine that counts as a right angle

std::vector<int> points_of(const DraftDirection& first, const DraftDirection& second) {
  std::vector<int> points{first.to, second.to};
  if (first.from >= 0) points.push_back(first.from);
  if (second.from >= 0) points.push_back(second.from);
  return points;
}

/// Any vector of length 1 at a right angle.
Vector3 any_across(const Vector3& x) {
  std::size_t least = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (std::abs(x[axis]) < std::abs(x[least])) least = axis;
  }
  Vector3 unit{};
  unit[least] = 1.0;
  const Vector3 across = cross(x, unit);
  return (1.0 / std::hypot(across[0], across[1], across[2])) * across;
}

}  // namespace

void SceneReader::read_constraint(const JsonNode& node) {
  static const std::vector<std::pair<std::string, Type>> kTypes = {
      {"distance", Type::distance},     {"angle", Type::angle},
      {"coincident", Type::coincident}, {"perpendicular", Type::perpendicular},
      {"on_line", Type::on_line},       {"dot", Type::dot},
      {"linear", Type::linear}};
  if (!node.is_object()) node.fail("an object");
  const JsonNode type = node.get("type");
  const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                  [&](const auto& known) { return known.first == type.text(); });
  if (found == kTypes.end()) {
    std::vector<std::string> names;
    for (const auto& known : kTypes) names.push_back(known.first);
    type.fail_name("a type", names);
  }
  DraftConstraint constraint{node, element_name(node), found->second};
  switch (constraint.type) {
    case Type::distance: {
      node.allow_keys({"type", "name", "between", "value"});
      const auto [a, b] = point_pair(node.get("between"));
      constraint.points = {a, b};
      use_between(node, constraint.points);
      break;
    }
    case Type::angle:
      node.allow_keys({"type", "name", "first", "second", "value"});
      read_angle(node, constraint);
      break;
    case Type::perpendicular:
      node.allow_keys({"type", "name", "first", "second"});
      read_angle(node, constraint);
      break;
    case Type::coincident:
      read_coincident(node, constraint);
      break;
    case Type::on_line:
      read_on_line(node, constraint);
      break;
    case Type::dot:
      read_dot(node, constraint);
      break;
    case Type::linear:
      read_linear(node, constraint);
      break;
  }
  if (const auto value = node.find("value")) {
    constraint.value =
        read_driver(*value, constraint.type == Type::angle ? "in rad" : "", &constraint);
  }
  draft_.constraints.push_back(std::move(constraint));
}

void SceneReader::read_angle(const JsonNode& node, DraftConstraint& constraint) {
  constraint.first = direction(node.get("first"));
  constraint.second = direction(node.get("second"));
  use_between(node, points_of(constraint.first, constraint.second));
}

void SceneReader::read_coincident(const JsonNode& node, DraftConstraint& constraint) {
  node.allow_keys({"type", "name", "points"});
  const auto [a, b] = point_pair(node.get("points"));
  constraint.points = {a, b};
  use_between(node, constraint.points);
}

void SceneReader::read_on_line(const JsonNode& node, DraftConstraint& constraint) {
  if (is_spatial()) {
    node.allow_keys({"type", "name", "point", "line", "direction"});
  } else {
    node.allow_keys({"type", "name", "point", "line"});
  }
  const int at = point(node.get("point"));
  const JsonNode line = node.get("line");
  if (is_spatial()) {
    constraint.points = {at, point(line)};
  } else {
    const auto [a, b] = point_pair(line);
    constraint.points = {at, a, b};
  }
  if (std::count(constraint.points.begin(), constraint.points.end(), at) > 1) {
    line.fail("the point " + in_quotes(node.get("point").text()) + " itself",
              "a line through other points");
  }
  if (is_spatial()) return read_line_in_space(node, constraint);
  use_between(node, constraint.points);
}

/// A fixed direction has fixed vectors across it; a body's needs two of the body's.
void SceneReader::read_line_in_space(const JsonNode& node, DraftConstraint& constraint) {
  const JsonNode direction = node.get("direction");
  constraint.direction = vector(direction);
  use_between(node, constraint.points);
  use(constraint.direction);
  const DraftPoint& along = draft_.point(constraint.direction);
  if (along.hold == Hold::fixed) return;
  if (along.bodies.empty()) {
    direction.fail("the free unit vector " + in_quotes(along.name) + " of no body",
                   "a fixed unit vector or one of a body");
  }
  const int with_line = common_body(draft_, {constraint.direction, constraint.points[1]});
  const int body = with_line >= 0 ? with_line : along.bodies.front();
  const Vector3 local = local_of(body, constraint.direction);
  constraint.normals[0] = vector_across(body, local);
  const Vector3 first = local_of(body, constraint.normals[0]);
  constraint.normals[1] = vector_across(body, local, &first);
}

Vector3 SceneReader::local_of(int body, int point) const {
  const std::vector<DraftBody::Item>& items = draft_.body(body).items;
  return std::find_if(items.begin(), items.end(), [&](const auto& it) { return it.point == point; })
      ->local;
}

int SceneReader::vector_across(int body, const Vector3& along, const Vector3* beside) {
  for (const DraftBody::Item& item : draft_.body(body).items) {
    if (!draft_.point(item.point).is_vector || std::abs(dot(item.local, along)) > kAcross) continue;
    if (beside != nullptr && std::abs(dot(item.local, *beside)) > kAcross) continue;
    use(item.point);
    return item.point;
  }
  const Vector3 local = beside != nullptr ? cross(along, *beside) : any_across(along);
  const int own = add_own(draft_, body, local, true, "n");
  use(own);
  return own;
}

void SceneReader::read_dot(const JsonNode& node, DraftConstraint& constraint) {
  node.allow_keys({"type", "name", "first", "second", "value"});
  const auto first = point_pair(node.get("first"));
  const auto second = point_pair(node.get("second"));
  constraint.first = {first.second, first.first};  // r_A - r_B
  constraint.second = {second.second, second.first};
  use_between(node, points_of(constraint.first, constraint.second));
}

void SceneReader::read_linear(const JsonNode& node, DraftConstraint& constraint) {
  node.allow_keys({"type", "name", "terms", "value"});
  const JsonNode list = node.get("terms");
  const auto nodes = list.items();
  if (nodes.empty() || nodes.size() > kMostTerms) {
    list.fail(fmt::format("an array of 1 to {} terms", kMostTerms));
  }
  std::unordered_map<int, std::string> path_of;  // by point and axis
  for (const JsonNode& item : nodes) {
    const DraftConstraint::Term term = read_term(item);
    const auto [same, is_new] = path_of.emplace(3 * term.point + term.axis, item.path());
    if (!is_new) item.fail("the same coordinate as in " + same->second, "one term a coordinate");
    constraint.terms.push_back(term);
  }
}

DraftConstraint::Term SceneReader::read_term(const JsonNode& node) {
  node.allow_keys({"point", "axis", "coefficient"});
  const JsonNode at = node.get("point");
  const int index = point(at);
  if (draft_.point(index).hold != Hold::free) {
    at.fail("the fixed or driven point " + in_quotes(at.text()), "a free point");
  }
  const JsonNode axis = node.get("axis");
  const std::string_view axes = kAxes.substr(0, static_cast<std::size_t>(draft_.dimension));
  const auto found = axes.find(axis.text());
  if (axis.text().size() != 1 || found == std::string_view::npos) {
    axis.fail(is_spatial() ? "\"x\", \"y\" or \"z\"" : "\"x\" or \"y\"");
  }
  const JsonNode coefficient = node.get("coefficient");
  if (coefficient.number() == 0.0) coefficient.fail("a number other than 0");
  use(index);
  return {index, static_cast<int>(found), coefficient.number()};
}

}  // namespace mbs
