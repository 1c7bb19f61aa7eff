// A body turns about a line of another and slides along it.
#include <fmt/format.h>

#include "scene_file/kinds/joint_parts.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {

void read_axis(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  constraint.axis = reader.vector(node.get("axis"));
  reader.use_between(node, {-1, constraint.direction}, {-1, constraint.axis});
}

void write_parallel_rows(Lowering& scene, const DraftConstraint& constraint) {
  const DraftDirection axis{-1, constraint.axis};
  if (constraint.normals[0] >= 0) {
    for (int k = 0; k < 2; ++k) {
      const DraftDirection normal{-1, constraint.normals[static_cast<std::size_t>(k)]};
      write_perpendicular_row(scene, constraint,
                              fmt::format("{} parallel {}", constraint.name, k + 1), normal, axis);
    }
    return;
  }
  const Vector3& u = scene.position(constraint.direction);
  const Vector3 normal = any_across(u);
  scene.distinct_linear(constraint.node, constraint.name + " parallel 1",
                        scene.fixed_dot(normal, axis), 0.0);
  scene.distinct_linear(constraint.node, constraint.name + " parallel 2",
                        scene.fixed_dot(cross(u, normal), axis), 0.0);
}

void read_cylindrical(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  node.allow_keys({"type", "name", "point", "line", "direction", "axis"});
  if (!reader.is_spatial()) {
    node.get("type").fail("a cylindrical joint in the plane", "prismatic, on_line or a shared point");
  }
  read_line(reader, node, constraint);
  read_axis(reader, node, constraint);
}

Lowering::Force lower_cylindrical(Lowering& scene, const DraftConstraint& constraint) {
  const RowMark before(scene.model());
  write_line_rows(scene, constraint);
  Lowering::Force force{Output::Force::vector, before.rows(scene.model()),
                        {constraint.points[1], constraint.points[0]}};
  write_parallel_rows(scene, constraint);
  return force;
}

}  // namespace mbs
