// Two points at one place, and two directions, the arms of the cross, at a right angle.
#include "scene_file/kinds/joint_parts.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {

void read_universal(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  node.allow_keys({"type", "name", "points", "first", "second"});
  if (!reader.is_spatial()) {
    node.get("type").fail("a universal joint in the plane", "coincident or a shared point");
  }
  const auto [a, b] = reader.point_pair(node.get("points"));
  constraint.points = {a, b};
  reader.use_between(node, constraint.points);
  constraint.first = reader.direction(node.get("first"));
  constraint.second = reader.direction(node.get("second"));
  reader.use_between(node, constraint.first, constraint.second);
}

Lowering::Force lower_universal(Lowering& scene, const DraftConstraint& constraint) {
  const RowMark before(scene.model());
  write_coincident_rows(scene, constraint);
  Lowering::Force force{Output::Force::vector, before.rows(scene.model()),
                        {constraint.points[1], constraint.points[0]}};
  for (const auto& [key, arm] : {std::pair{"first", constraint.first}, {"second", constraint.second}}) {
    if (norm(scene.along(arm)) > 0.0) continue;
    constraint.node.get(key).fail("a direction between points that start at the same place",
                                  "a direction of length above 0");
  }
  write_perpendicular_row(scene, constraint, constraint.name + " cross", constraint.first,
                          constraint.second);
  return force;
}

}  // namespace mbs
