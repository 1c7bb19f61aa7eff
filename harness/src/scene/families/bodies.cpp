// A chain of rigid bodies with hinges, in the plane or in space.
#include <cmath>

#include "scene/families/families.hpp"
#include "scene/families/scene_writer.hpp"

namespace mbs {

SceneSize bodies_size(const FamilyValues& values) {
  const long bodies = values[0];
  return values[1] == 2 ? SceneSize{2 * bodies, bodies} : SceneSize{6 * bodies, 5 * bodies};
}

/// Body K_i is hinged to the one before at J_(i-1), in space about the axis a_(i-1); the next axis
/// is at a right angle. Centres of mass are off the line of the hinges, in space to both sides, so
/// that every hinge turns.
nlohmann::json bodies_document(const FamilyValues& values) {
  constexpr double kLength = 1.0, kMass = 2.0, kLean = 0.2;  // m from hinge to hinge, kg, rad
  const int bodies = values[0], dimension = values[1];
  SceneWriter scene(dimension);
  const Vector3 along{std::sin(kLean), -std::cos(kLean), 0.0};
  Vector3 axis{0.0, 0.0, 1.0};
  const auto add_hinge = [&](int i) {
    nlohmann::json point{{"name", numbered("J", i)},
                         {"position", scene.vector(i * kLength * along)}};
    nlohmann::json vector{{"name", numbered("a", i)}, {"direction", scene.vector(axis)}};
    if (i == 0) point["fixed"] = vector["fixed"] = true;
    scene.add("points", point);
    if (dimension == 3) scene.add("vectors", vector);
  };
  add_hinge(0);
  for (int i = 1; i <= bodies; ++i) {
    axis = cross(axis, along);
    add_hinge(i);
    const std::string from = numbered("J", i - 1), to = numbered("J", i);
    nlohmann::json body{{"name", numbered("K", i)}, {"mass", kMass}};
    body["centre"] = scene.vector({kLength / 2.0, 0.05, 0.03});
    body["points"] = {{from, scene.vector({})}, {to, scene.vector({kLength, 0.0, 0.0})}};
    if (dimension == 2) {
      body["inertia"] = 0.2;
    } else {
      body["inertia"] = {0.05, 0.2, 0.2};
      body["vectors"] = {{numbered("a", i - 1), {0, 0, 1}}, {numbered("a", i), {0, 1, 0}}};
    }
    scene.add("bodies", body);
  }
  scene.position_output(numbered("J", bodies));
  return std::move(scene).finish();
}

}  // namespace mbs
