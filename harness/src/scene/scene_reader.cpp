// Reading order: dimension, gravity, points, vectors, bodies, rods, masses, constraints, forces.
#include "scene/scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "printable.hpp"
#include "scene/read_function.hpp"

namespace mbs {
namespace {

constexpr double kLeastDistance = 1e-150;  // m, whose square is still a number above 0

}  // namespace

SceneDraft SceneReader::read() {
  root_.allow_keys({"dimension", "gravity", "points", "vectors", "rods", "masses", "bodies",
                    "constraints", "springs", "torsion_springs", "force_laws", "torque_laws",
                    "forces", "torques", "assembly", "outputs", "$schema"});
  read_dimension_and_gravity();
  if (!root_.find("bodies")) static_cast<void>(root_.get("points"));
  for (const JsonNode& node : list("points")) read_point(node);
  for (const JsonNode& node : list("vectors")) read_vector(node);
  for (const JsonNode& node : list("bodies")) read_body(node);
  for (const JsonNode& node : list("rods")) read_rod(node);
  for (const JsonNode& node : list("masses")) read_mass(node);
  for (const JsonNode& node : list("constraints")) read_constraint(node);
  for (const JsonNode& node : list("springs")) read_spring(node);
  for (const JsonNode& node : list("torsion_springs")) read_torsion_spring(node);
  for (const JsonNode& node : list("force_laws")) read_force_law(node);
  for (const JsonNode& node : list("torque_laws")) read_torque_law(node);
  for (const JsonNode& node : list("forces")) read_force(node);
  for (const JsonNode& node : list("torques")) read_torque(node);
  for (const JsonNode& node : list("outputs")) read_output(node);
  if (const auto node = root_.find("assembly")) read_assembly(*node);
  return std::move(draft_);
}

std::vector<JsonNode> SceneReader::list(std::string_view key) const {
  const auto node = root_.find(key);
  return node ? node->items() : std::vector<JsonNode>{};
}

void SceneReader::read_dimension_and_gravity() {
  if (const auto node = root_.find("dimension")) {
    const double dimension = node->number();
    if (dimension != 2.0 && dimension != 3.0) node->fail("2 or 3");
    draft_.dimension = static_cast<int>(dimension);
  }
  if (const auto node = root_.find("gravity")) draft_.gravity = coordinates(*node);
}

void SceneReader::read_point(const JsonNode& node) {
  node.allow_keys({"name", "position", "velocity", "fixed", "driven"});
  const JsonNode name = node.get("name");
  DraftPoint& point = draft_.point(add_name(name, name.text(), false));
  point.node = node;
  if (const auto position = node.find("position")) point.position = coordinates(*position);
  const auto fixed = node.find("fixed");
  if (fixed && fixed->boolean()) point.hold = Hold::fixed;
  if (const auto driven = node.find("driven")) {
    if (point.hold == Hold::fixed) driven->fail("a driven point that is fixed", "one of the two");
    read_driven(*driven, point);
  }
  if (point.hold == Hold::fixed && !point.position) static_cast<void>(node.get("position"));
  if (const auto velocity = node.find("velocity")) {
    point.velocity = coordinates(*velocity);
    if (point.hold != Hold::free && *point.velocity != Vector3{}) {
      velocity->fail("a moving fixed or driven point", "zero, or a point that is free");
    }
  }
}

/// Axes that "driven" leaves out stay where "position" has them.
void SceneReader::read_driven(const JsonNode& node, DraftPoint& point) {
  if (is_spatial()) {
    node.allow_keys({"x", "y", "z"});
  } else {
    node.allow_keys({"x", "y"});
  }
  bool moves = false;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(draft_.dimension); ++axis) {
    const std::string key(1, static_cast<char>('x' + axis));
    const auto function = node.find(key);
    if (!function && !point.position) static_cast<void>(node.get(key));
    point.motion[axis] = function ? read_driver(*function, "in m") : (*point.position)[axis];
    moves = moves || !point.motion[axis].is_constant();
  }
  point.hold = moves ? Hold::driven : Hold::fixed;
  if (moves) return;
  point.position.emplace();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    (*point.position)[axis] = point.motion[axis].at(0.0).value;
  }
}

TimeFunction SceneReader::read_driver(const JsonNode& node, const std::string& unit,
                                      const DraftConstraint* constraint) {
  using Type = DraftConstraint::Type;
  const GivenFunction given = read_function(node, unit);
  if (given.value.is_constant()) return given.value;
  Driver driver{node.path(), constraint == nullptr ? "" : constraint->name, given.value,
                given.longest_step, given.resolution};
  if (constraint != nullptr && constraint->type == Type::distance) {
    driver.least = kLeastDistance;
    driver.range = "a distance in m above 0";
  }
  if (constraint != nullptr && constraint->type == Type::angle) {
    driver.largest_change = 2 * std::numbers::pi / kStepsPerPeriod;
    if (is_spatial()) {
      driver.least = kLeastSpatialAngle;
      driver.most = std::numbers::pi - kLeastSpatialAngle;
      driver.range = fmt::format("{0} to pi - {0} rad", kLeastSpatialAngle);
    }
  }
  draft_.drivers.push_back(std::move(driver));
  return given.value;
}

void SceneReader::read_vector(const JsonNode& node) {
  if (!is_spatial()) node.fail("a unit vector in a planar scene", "none, or \"dimension\": 3");
  node.allow_keys({"name", "direction", "velocity", "fixed"});
  const JsonNode name = node.get("name");
  DraftPoint& vector = draft_.point(add_name(name, name.text(), true));
  vector.node = node;
  if (const auto direction = node.find("direction")) vector.position = unit_vector(*direction);
  if (const auto velocity = node.find("velocity")) vector.velocity = coordinates(*velocity);
  const auto fixed = node.find("fixed");
  if (!fixed || !fixed->boolean()) return;
  if (vector.velocity.value_or(Vector3{}) != Vector3{}) {
    node.get("velocity").fail("a moving fixed unit vector", "zero, or a unit vector that is free");
  }
  if (!vector.position) static_cast<void>(node.get("direction"));
  vector.hold = Hold::fixed;
}

void SceneReader::read_rod(const JsonNode& node) {
  node.allow_keys({"name", "between", "mass", "length"});
  const JsonNode between = node.get("between");
  const auto [a, b] = point_pair(between);
  use_between(between, {a, b});
  DraftRod rod{node, element_name(node), a, b,
               node.get("mass").number_at_least(0.0, "a mass in kg of at least 0 (0: massless)")};
  if (const auto length = node.find("length")) {
    rod.length = length->number_above(0.0, "a length in m above 0");
  }
  draft_.rods.push_back(std::move(rod));
}

void SceneReader::read_mass(const JsonNode& node) {
  node.allow_keys({"point", "mass"});
  const JsonNode at = node.get("point");
  const int index = point(at);
  if (draft_.point(index).hold != Hold::free) {
    at.fail("the fixed or driven point " + in_quotes(at.text()),
            "a free point (a mass there has no effect)");
  }
  draft_.point(index).is_loaded = true;
  draft_.masses.push_back(
      {node, index, node.get("mass").number_above(0.0, "a mass in kg above 0")});
}

void SceneReader::read_assembly(const JsonNode& node) {
  node.allow_keys({"largest_correction"});
  draft_.largest_correction =
      node.get("largest_correction").number_at_least(0.0, "a distance in m of at least 0");
}

}  // namespace mbs
