// A body slides along a line of another and does not turn against it.
#include <cmath>

#include "scene_file/kinds/joint_parts.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {
namespace {

void read_across(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  const JsonNode across = node.get("across");
  const auto items = across.items();
  if (items.size() != 2) across.fail("an array of two directions, one of each body");
  constraint.first = reader.direction(items[0]);
  constraint.second = reader.direction(items[1]);
  reader.use_between(across, constraint.first, constraint.second);
}

/// A turn about the line must change the product of the two directions, else nothing holds it.
void require_across(Lowering& scene, const DraftConstraint& constraint) {
  const Vector3 m = scene.along(constraint.first), n = scene.along(constraint.second);
  const double turned = std::abs(dot(scene.position(constraint.direction), cross(m, n)));
  if (turned > 0.5 * norm(m) * norm(n)) return;
  constraint.node.get("across").fail("directions that do not tell a turn about the line",
                                     "two across the line, about at a right angle to each other");
}

}  // namespace

void read_prismatic(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  if (reader.is_spatial()) {
    node.allow_keys({"type", "name", "point", "line", "direction", "axis", "across"});
    read_line(reader, node, constraint);
    read_axis(reader, node, constraint);
    read_across(reader, node, constraint);
    return;
  }
  node.allow_keys({"type", "name", "point", "line", "axis"});
  read_line(reader, node, constraint);
  constraint.first = {constraint.points[1], constraint.points[2]};
  constraint.second = reader.direction(node.get("axis"));
  reader.use_between(node, constraint.first, constraint.second);
}

Lowering::Force lower_prismatic(Lowering& scene, const DraftConstraint& constraint) {
  const RowMark before(scene.model());
  write_line_rows(scene, constraint);
  Lowering::Force force{Output::Force::vector, before.rows(scene.model()),
                        {constraint.points[1], constraint.points[0]}};
  if (scene.draft().dimension == 3) {
    require_across(scene, constraint);
    write_parallel_rows(scene, constraint);
    write_perpendicular_row(scene, constraint, constraint.name + " across", constraint.first,
                            constraint.second);
    return force;
  }
  if (!(norm(scene.along(constraint.second)) > 0.0)) {
    constraint.node.get("axis").fail("a direction between points that start at the same place",
                                     "a direction of length above 0");
  }
  write_kept_angle_row(scene, constraint);
  return force;
}

}  // namespace mbs
