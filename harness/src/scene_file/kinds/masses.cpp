// Point masses.
#include "printable.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {

void read_mass(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"point", "mass"});
  const JsonNode at = node.get("point");
  const int index = reader.point(at);
  if (reader.draft().point(index).hold != Hold::free) {
    at.fail("the fixed or driven point " + in_quotes(at.text()),
            "a free point (a mass there has no effect)");
  }
  reader.draft().point(index).is_loaded = true;
  reader.draft().masses.push_back(
      {node, index, node.get("mass").number_above(0.0, "a mass in kg above 0")});
}

void lower_masses(Lowering& scene) {
  for (const DraftMass& mass : scene.draft().masses) {
    const DraftPoint& point = scene.draft().point(mass.point);
    if (point.index >= 0) {
      scene.mass().add_point_mass(point.index, mass.mass, scene.draft().gravity);
    } else {  // on a body and nothing else: part of it
      DraftBody& body = scene.draft().body(point.bodies.front());
      body.inertia = with_point_mass(body.inertia, body.items[point.item].local, mass.mass,
                                     scene.draft().dimension);
    }
  }
}

}  // namespace mbs
