// Rods: mass and a distance.
#include <algorithm>
#include <cmath>

#include "scene_file/kinds/kinds.hpp"

namespace mbs {

void read_rod(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "between", "mass", "length"});
  const JsonNode between = node.get("between");
  const auto [a, b] = reader.point_pair(between);
  reader.use_between(between, {a, b});
  DraftRod rod{node, reader.element_name(node), a, b,
               node.get("mass").number_at_least(0.0, "a mass in kg of at least 0 (0: massless)")};
  if (const auto length = node.find("length")) {
    rod.length = length->number_above(0.0, "a length in m above 0");
  }
  reader.draft().rods.push_back(std::move(rod));
}

void lower_rods(Lowering& scene) {
  for (const DraftRod& rod : scene.draft().rods) {
    const JsonNode between = rod.node.get("between");
    const Vector3 difference = scene.position(rod.a) - scene.position(rod.b);
    if (!(dot(difference, difference) > 0.0)) {
      between.fail("a rod of length 0 (its points start at the same place)", "a length above 0");
    }
    const double squared = rod.length ? *rod.length * *rod.length : dot(difference, difference);
    if (!(squared > 0.0)) rod.node.get("length").fail("a length in m above 0, as is its square");
    const int a = scene.index(rod.a), b = scene.index(rod.b);
    scene.refuse_same_dot(rod.node, {rod.a, rod.b}, {rod.a, rod.b});
    scene.remember(rod.node, {Output::Force::tension,
                              {{Lowering::Row::Kind::dot, scene.model().dot_constraints.size()}},
                              {rod.a, rod.b}});
    scene.mass().add_rod({a, b, rod.mass, squared, rod.name}, scene.draft().gravity);
    scene.keep_length(a, b, std::sqrt(squared));
    const auto name = rod.node.find("name");
    scene.elements().rods.push_back({name ? name->text() : rod.name, a, b});
  }
}

}  // namespace mbs
