// Dense clusters of points, each point tied to each other, with chains between them.
#include <cmath>
#include <numbers>

#include "scene/families/families.hpp"
#include "scene/families/scene_writer.hpp"

namespace mbs {
namespace {

constexpr int kChainPieces = 3;  // of a chain from cluster to cluster

}  // namespace

SceneSize clusters_size(const FamilyValues& values) {
  const long clusters = values[0], points = values[1];
  return {2 * clusters * points + 2 * (clusters - 1) * (kChainPieces - 1),
          (clusters - 1) * kChainPieces};
}

/// Each cluster is a soft body: a ring of masses, all of them tied to all others by springs, as
/// stiff as makes the ring breathe at kBreathing. Buoyancy is a spring from above each mass. It
/// starts a little high, sinks in and pulls at the chains, which hang from cluster to cluster.
nlohmann::json clusters_document(const FamilyValues& values) {
  constexpr double kRadius = 1.0, kMass = 2.0, kBreathing = 12.0;        // m, kg, rad/s
  constexpr double kSinks = 0.2, kStart = 0.15, kAbove = 2.0;            // m
  constexpr double kLink = 0.6, kLinkMass = 0.6, kSlope = 50.0 / 180.0;  // m, kg, half turns
  const int clusters = values[0], points = values[1];
  SceneWriter scene;
  const auto name = [](int cluster, int i) { return fmt::format("P{}_{}", cluster, i); };
  const int left = points / 2;  // opposite of point 0, which is to the right
  const double turn = 2.0 * std::numbers::pi / points;
  const Vector3 fall = kLink * Vector3{std::cos(kSlope * std::numbers::pi),
                                       -std::sin(kSlope * std::numbers::pi), 0.0};
  // From point 0 down, along and up to `left` of the next cluster, which is a little higher or not.
  const Vector3 gap{2.0 * fall[0] + kLink, 0.0, 0.0};
  const Vector3 right_of_left =
      kRadius * Vector3{1.0 - std::cos(left * turn), -std::sin(left * turn), 0.0};
  Vector3 centre{};
  for (int c = 0; c < clusters; ++c) {
    for (int i = 0; i < points; ++i) {
      const Vector3 r = centre + kRadius * Vector3{std::cos(i * turn), std::sin(i * turn), 0.0};
      const std::string above = fmt::format("A{}_{}", c, i);
      scene.fixed(above, r + Vector3{0.0, kAbove, 0.0});
      scene.point(name(c, i), r);
      scene.mass(name(c, i), kMass);
      scene.spring(above, name(c, i), kMass * 9.81 / kSinks, kAbove - kStart);
      for (int j = 0; j < i; ++j) {
        scene.spring(name(c, j), name(c, i), kBreathing * kBreathing * kMass / points);
      }
    }
    if (c + 1 == clusters) break;
    const Vector3 begin = centre + Vector3{kRadius, 0.0, 0.0};
    const std::string down = fmt::format("C{}_1", c), up = fmt::format("C{}_2", c);
    scene.point(down, begin + fall);
    scene.point(up, begin + fall + Vector3{kLink, 0.0, 0.0});
    scene.rod(name(c, 0), down, kLinkMass);
    scene.rod(down, up, kLinkMass);
    scene.rod(up, name(c + 1, left), kLinkMass);
    centre = centre + gap + right_of_left;
  }
  scene.position_output(name(0, 0));
  return std::move(scene).finish();
}

}  // namespace mbs
