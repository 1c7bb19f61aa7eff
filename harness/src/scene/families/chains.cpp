// Links in a row, in a ring with the ground, as a tree and as a ladder; all start at rest but the
// spatial chain.
#include <cmath>
#include <numbers>

#include "scene/families/families.hpp"
#include "scene/families/scene_writer.hpp"

namespace mbs {
namespace {

constexpr double kChainLink = 1.0, kChainMass = 1.0;  // m, kg
constexpr double kChainLean = 0.25;                   // rad from the vertical

}  // namespace

SceneSize chain_size(const FamilyValues& values) {
  return {long{values[1]} * values[0], values[0]};
}

/// Hangs straight and leans. In space it also goes round the vertical as a whole, as fast as one
/// rod of its length would have to in order to keep its lean.
nlohmann::json chain_document(const FamilyValues& values) {
  const int links = values[0];
  SceneWriter scene(values[1]);
  const Vector3 link = kChainLink * Vector3{std::sin(kChainLean), -std::cos(kChainLean), 0.0};
  const double round =
      values[1] == 2
          ? 0.0
          : std::sqrt(1.5 * 9.81 / (links * kChainLink * std::cos(kChainLean)));  // rad/s
  scene.fixed("P0", {});
  for (int i = 1; i <= links; ++i) {
    const Vector3 r = double(i) * link;
    scene.point(numbered("P", i), r, cross({0.0, round, 0.0}, r));
    scene.rod(numbered("P", i - 1), numbered("P", i), kChainMass);
  }
  scene.position_output(numbered("P", links));
  return std::move(scene).finish();
}

SceneSize loop_size(const FamilyValues& values) {
  const long links = values[0];
  return {2 * (links - 1), links};
}

/// On an arc of a circle, which hanging links leave for a catenary; left mirrors right.
nlohmann::json loop_document(const FamilyValues& values) {
  const int links = values[0];
  SceneWriter scene;
  Vector3 r{};
  scene.fixed("P0", r);
  for (int i = 1; i <= links; ++i) {
    const double angle = (2.0 * i - 1.0 - links) / links * std::numbers::pi / 4.0;
    r = r + kChainLink * Vector3{std::cos(angle), std::sin(angle), 0.0};
    if (i == links) {
      scene.fixed(numbered("P", i), r);
    } else {
      scene.point(numbered("P", i), r);
    }
    scene.rod(numbered("P", i - 1), numbered("P", i), kChainMass);
  }
  scene.position_output(numbered("P", links / 2));
  return std::move(scene).finish();
}

SceneSize tree_size(const FamilyValues& values) { return {2L * values[0], values[0]}; }

/// Below point i hang 2 i + 1, to the left, and 2 i + 2, to the right. A rod weighs a kilogram more
/// than the two below it: so no rod is light for what it carries. The lighter, the farther out it
/// starts, for what moves a heavy rod a little moves a light one below it far.
nlohmann::json tree_document(const FamilyValues& values) {
  constexpr double kSpread = 0.15;  // rad from the vertical, of a rod of 1 kg
  const auto rods = static_cast<std::size_t>(values[0]);
  std::vector<double> masses(rods + 1, 1.0);  // kg, of the rod to a point
  for (std::size_t i = rods; i > 0; --i) masses[(i - 1) / 2] += masses[i];
  SceneWriter scene;
  std::vector<Vector3> places{{}};
  scene.fixed("P0", {});
  for (std::size_t i = 1; i <= rods; ++i) {
    const double lean = (i % 2 == 1 ? -kSpread : kSpread) / std::sqrt(masses[i]);
    places.push_back(places[(i - 1) / 2] +
                     kChainLink * Vector3{std::sin(lean), -std::cos(lean), 0.0});
    scene.point(numbered("P", i), places.back());
    scene.rod(numbered("P", (i - 1) / 2), numbered("P", i), masses[i]);
  }
  scene.position_output(numbered("P", rods));
  return std::move(scene).finish();
}

SceneSize ladder_size(const FamilyValues& values) { return {4L * values[0], 3L * values[0]}; }

/// Leans; its rungs stay level, for its sides move alike.
nlohmann::json ladder_document(const FamilyValues& values) {
  constexpr double kRise = 0.5, kWidth = 0.5, kRungMass = 0.5;  // m, m, kg
  SceneWriter scene;
  const Vector3 rise = kRise * Vector3{std::sin(kChainLean), -std::cos(kChainLean), 0.0};
  scene.fixed("A0", {});
  scene.fixed("B0", {kWidth, 0.0, 0.0});
  for (int i = 1; i <= values[0]; ++i) {
    const Vector3 r = double(i) * rise;
    scene.point(numbered("A", i), r);
    scene.point(numbered("B", i), r + Vector3{kWidth, 0.0, 0.0});
    for (const char* side : {"A", "B"}) {
      scene.rod(numbered(side, i - 1), numbered(side, i), kChainMass);
    }
    scene.rod(numbered("A", i), numbered("B", i), kRungMass);
  }
  scene.position_output(numbered("A", values[0]));
  return std::move(scene).finish();
}

}  // namespace mbs
