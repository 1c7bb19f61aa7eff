// A long vehicle: one chassis, axles on trailing arms with springs and dampers, tyres on a road.
#include <cmath>
#include <numbers>

#include "scene/families/families.hpp"
#include "scene/families/scene_writer.hpp"

namespace mbs {

SceneSize vehicle_size(const FamilyValues& values) {
  const long axles = values[0];
  return {6 * axles, 5 * axles - 2};
}

/// Seen from the side, in a frame that travels with it. It stands at rest with its weight on the
/// springs; from then on the road moves under the tyres as a wave that runs from front to back.
nlohmann::json vehicle_document(const FamilyValues& values) {
  constexpr double kApart = 1.5, kLoad = 2000.0, kHub = 400.0;  // m, kg, kg an axle
  constexpr double kSpring = 150e3, kDamper = 10e3;             // N/m, N s/m
  constexpr double kTyre = 400e3, kTyreDamper = 2e3;
  constexpr double kWave = 0.01, kWaveLength = 10.0, kFrequency = 1.0;  // m, m, Hz
  constexpr double kHubHeight = 0.3, kMountHeight = 0.75, kArm = 0.4;   // m
  const int axles = values[0];
  SceneWriter scene;
  const double length = kApart * axles;
  nlohmann::json chassis{{"name", "chassis"},
                         {"mass", kLoad * axles},
                         {"inertia", kLoad * axles * (length * length + 1.0) / 12.0},
                         {"centre", {-kApart * (axles - 1) / 2.0, 0.6}}};
  for (int i = 0; i < axles; ++i) {
    const double x = -kApart * i;
    const std::string hub = numbered("hub", i), mount = numbered("mount", i),
                      pivot = numbered("pivot", i), road = numbered("road", i);
    const double phase = std::remainder(x / kWaveLength, 1.0) * 2.0 * std::numbers::pi;
    scene.add(
        "points",
        {{"name", road},
         {"position", {x, kWave * std::sin(phase)}},
         {"driven",
          {{"y",
            {{"sine", {{"amplitude", kWave}, {"frequency", kFrequency}, {"phase", phase}}}}}}}});
    const Vector3 at_mount{x, kMountHeight, 0.0}, at_pivot{x + kArm, kHubHeight, 0.0};
    scene.point(hub, {x, kHubHeight, 0.0});
    scene.point(mount, at_mount);
    scene.point(pivot, at_pivot);
    chassis["points"][mount] = scene.vector(at_mount);
    chassis["points"][pivot] = scene.vector(at_pivot);
    scene.mass(hub, kHub);
    scene.rod(pivot, hub, 0.0);
    scene.spring(mount, hub, kSpring, kMountHeight - kHubHeight + kLoad * 9.81 / kSpring, kDamper);
    scene.spring(road, hub, kTyre, kHubHeight + (kLoad + kHub) * 9.81 / kTyre, kTyreDamper);
  }
  scene.add("bodies", chassis);
  const nlohmann::json term{{"point", "pivot0"}, {"axis", "x"}, {"coefficient", 1.0}};
  scene.add("constraints", {{"name", "keeps its place"},
                            {"type", "linear"},
                            {"terms", nlohmann::json::array({term})},
                            {"value", kArm}});
  scene.position_output("mount0");
  scene.position_output("hub0");
  return std::move(scene).finish();
}

}  // namespace mbs
