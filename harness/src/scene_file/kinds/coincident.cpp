// Two points at one place.
#include <fmt/format.h>

#include "scene_file/kinds/joint_parts.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {

void read_coincident(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  node.allow_keys({"type", "name", "points"});
  const auto [a, b] = reader.point_pair(node.get("points"));
  constraint.points = {a, b};
  reader.use_between(node, constraint.points);
}

void write_coincident_rows(Lowering& scene, const DraftConstraint& constraint) {
  const int a = scene.index(constraint.points[0]), b = scene.index(constraint.points[1]);
  for (int axis = 0; axis < scene.draft().dimension; ++axis) {
    scene.distinct_linear(constraint.node, fmt::format("{} {}", constraint.name, "xyz"[axis]),
                          {{a, axis, 1.0}, {b, axis, -1.0}}, 0.0);
  }
}

Lowering::Force lower_coincident(Lowering& scene, const DraftConstraint& constraint) {
  write_coincident_rows(scene, constraint);
  return {Output::Force::vector, {}, {constraint.points[1], constraint.points[0]}};
}

}  // namespace mbs
