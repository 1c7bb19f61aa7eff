// A scalar product of two differences.
#include "scene_file/kinds/drivers.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {

void read_dot(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  node.allow_keys({"type", "name", "first", "second", "value"});
  const auto first = reader.point_pair(node.get("first"));
  const auto second = reader.point_pair(node.get("second"));
  constraint.first = {first.second, first.first};  // r_A - r_B
  constraint.second = {second.second, second.first};
  reader.use_between(node, constraint.first, constraint.second);
  read_value(reader, constraint);
}

Lowering::Force lower_dot(Lowering& scene, const DraftConstraint& constraint) {
  const Vector3 u = scene.along(constraint.first), w = scene.along(constraint.second);
  if (!(dot(u, u) > 0.0 || dot(w, w) > 0.0)) {
    constraint.node.fail("two differences of length 0 at the start", "at most one");
  }
  const Lowering::Edge first = scene.edge(constraint.first), second = scene.edge(constraint.second);
  scene.refuse_same_dot(constraint.node, constraint.first, constraint.second);
  scene.rows().dot(constraint.name, first, second, constraint.value.value_or(dot(u, w)));
  return {Output::Force::multiplier};
}

}  // namespace mbs
