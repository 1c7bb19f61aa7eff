// Constraints of all types.
#include <algorithm>

#include "scene_file/kinds/kinds.hpp"

namespace mbs {

void read_constraint(SceneReader& reader, const JsonNode& node) {
  if (!node.is_object()) node.fail("an object");
  const JsonNode type = node.get("type");
  const auto kinds = constraint_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&](const auto& kind) { return kind.type == type.text(); });
  if (found == kinds.end()) {
    std::vector<std::string> names;
    for (const ConstraintKind& kind : kinds) names.emplace_back(kind.type);
    type.fail_name("a type", names);
  }
  DraftConstraint constraint{node, reader.element_name(node), &*found};
  found->read(reader, node, constraint);
  reader.draft().constraints.push_back(std::move(constraint));
}

void lower_constraints(Lowering& scene) {
  using Row = Lowering::Row;
  const ModelData& data = scene.model();
  for (const DraftConstraint& constraint : scene.draft().constraints) {
    const std::size_t dots = data.dot_constraints.size();
    const std::size_t bilinears = data.bilinear_constraints.size();
    const std::size_t linears = data.linear_constraints.size();
    Lowering::Force force = constraint.kind->lower(scene, constraint);
    const auto add = [&force](Row::Kind kind, std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) force.rows.push_back({kind, i});
    };
    add(Row::Kind::dot, dots, data.dot_constraints.size());
    add(Row::Kind::bilinear, bilinears, data.bilinear_constraints.size());
    add(Row::Kind::linear, linears, data.linear_constraints.size());
    scene.remember(constraint.node, std::move(force));
  }
}

}  // namespace mbs
