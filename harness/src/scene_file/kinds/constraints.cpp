// Constraints of all types.
#include <algorithm>

#include "scene_file/kinds/joint_parts.hpp"
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

RowMark::RowMark(const ModelData& data)
    : dots_(data.dot_constraints.size()),
      bilinears_(data.bilinear_constraints.size()),
      linears_(data.linear_constraints.size()) {}

std::vector<Lowering::Row> RowMark::rows(const ModelData& data) const {
  using Row = Lowering::Row;
  std::vector<Row> result;
  const auto add = [&result](Row::Kind kind, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) result.push_back({kind, i});
  };
  add(Row::Kind::dot, dots_, data.dot_constraints.size());
  add(Row::Kind::bilinear, bilinears_, data.bilinear_constraints.size());
  add(Row::Kind::linear, linears_, data.linear_constraints.size());
  return result;
}

void lower_constraints(Lowering& scene) {
  for (const DraftConstraint& constraint : scene.draft().constraints) {
    const RowMark before(scene.model());
    Lowering::Force force = constraint.kind->lower(scene, constraint);
    if (force.rows.empty()) force.rows = before.rows(scene.model());
    scene.remember(constraint.node, std::move(force));
  }
}

}  // namespace mbs
