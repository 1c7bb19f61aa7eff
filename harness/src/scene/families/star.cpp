// One rotor with many hinged blades, seen along its axis: a dense row.
#include <cmath>
#include <numbers>

#include "scene/families/families.hpp"
#include "scene/families/scene_writer.hpp"

namespace mbs {

SceneSize star_size(const FamilyValues& values) {
  const long blades = values[0];
  return {4 * blades, 3 * blades - 1};
}

/// Turns evenly with its blades out, one lagging, one leading, from where they swing about the
/// radial position.
nlohmann::json star_document(const FamilyValues& values) {
  constexpr double kRim = 0.5, kBlade = 1.0, kBladeMass = 1.0;  // m, m, kg
  constexpr double kTurning = 3.0, kLag = 0.2;                  // rad/s, rad
  const int blades = values[0];
  SceneWriter scene;
  scene.gravity({});
  scene.fixed("O", {});
  nlohmann::json rotor{{"name", "rotor"},
                       {"mass", 5.0 * blades},
                       {"inertia", 1.0 * blades},
                       {"points", {{"O", {0, 0}}}},
                       {"angular_velocity", kTurning}};
  for (int i = 0; i < blades; ++i) {
    const double at = 2.0 * std::numbers::pi * i / blades, lag = i % 2 == 0 ? kLag : -kLag;
    const Vector3 rim = kRim * Vector3{std::cos(at), std::sin(at), 0.0};
    const Vector3 tip = rim + kBlade * Vector3{std::cos(at + lag), std::sin(at + lag), 0.0};
    const std::string R = numbered("R", i), T = numbered("T", i);
    scene.point(R, rim);
    scene.point(T, tip, cross({0.0, 0.0, kTurning}, tip));
    rotor["points"][R] = scene.vector(rim);
    scene.rod(R, T, kBladeMass);
  }
  scene.add("bodies", rotor);
  scene.position_output("R0");
  scene.position_output("T0");
  return std::move(scene).finish();
}

}  // namespace mbs
