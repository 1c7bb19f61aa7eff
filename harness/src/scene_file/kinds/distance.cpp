// A distance between two points.
#include <algorithm>

#include "scene/time_functions.hpp"
#include "scene_file/kinds/drivers.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {
namespace {

constexpr double kLeastDistance = 1e-150;  // m, whose square is still a number above 0

}  // namespace

void read_distance(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  node.allow_keys({"type", "name", "between", "value"});
  const auto [a, b] = reader.point_pair(node.get("between"));
  constraint.points = {a, b};
  reader.use_between(node, constraint.points);
  Driver driver;
  driver.least = kLeastDistance;
  driver.range = "a distance in m above 0";
  read_value(reader, constraint, "", driver);
}

Lowering::Force lower_distance(Lowering& scene, const DraftConstraint& constraint) {
  const int a = scene.index(constraint.points[0]), b = scene.index(constraint.points[1]);
  const double start =
      norm(scene.position(constraint.points[0]) - scene.position(constraint.points[1]));
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
  scene.refuse_same_dot(constraint.node, between, between);
  scene.rows().dot(constraint.name, {a, b}, {a, b}, squared);
  const auto name = constraint.node.find("name");
  scene.elements().distances.push_back({name ? name->text() : constraint.name, a, b});
  if (length.is_constant()) scene.keep_length(a, b, length.at(0.0).value);
  return {Output::Force::tension, {}, between};
}

}  // namespace mbs
