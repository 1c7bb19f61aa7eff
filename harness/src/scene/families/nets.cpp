// Nets of rods: one that folds, hung in space, and rigid ones, hinged to a boom.
#include <cmath>

#include "scene/families/families.hpp"
#include "scene/families/scene_writer.hpp"

namespace mbs {

SceneSize grid_size(const FamilyValues& values) {
  const long rows = values[0], columns = values[1];
  return {3 * rows * (columns + 1), rows * (2 * columns + 1)};
}

/// Folded to and fro along its upper edge, so that no cord of it is in one plane with all others;
/// the cords that hang lean. A rope along each side weighs half a cord a mesh, so that columns
/// weigh alike: they move alike.
nlohmann::json grid_document(const FamilyValues& values) {
  constexpr double kMesh = 0.5, kCordMass = 0.2;  // m, kg
  constexpr double kFold = 0.3, kLean = 0.4;      // rad
  const int rows = values[0], columns = values[1];
  SceneWriter scene(3);
  const double across = std::sin(kLean) * std::sqrt(0.5);
  const Vector3 down = kMesh * Vector3{across, -std::cos(kLean), across};
  const auto name = [](int row, int column) { return fmt::format("P{}_{}", row, column); };
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j <= columns; ++j) {
      const double out = j % 2 == 0 ? 0.0 : std::sin(kFold);
      const Vector3 r = kMesh * Vector3{j * std::cos(kFold), 0.0, out} + double(i) * down;
      if (i == 0) {
        scene.fixed(name(i, j), r);
        continue;
      }
      scene.point(name(i, j), r);
      scene.rod(name(i - 1, j), name(i, j), kCordMass);
      if (j > 0) scene.rod(name(i, j - 1), name(i, j), kCordMass);
      if (j == 0 || j == columns) scene.mass(name(i, j), kCordMass / 2.0);
    }
  }
  scene.position_output(name(rows, columns));
  return std::move(scene).finish();
}

SceneSize truss_size(const FamilyValues& values) {
  const long lattices = values[0], bays = values[1];
  return {lattices * (4 * bays + 2), lattices * (5 * bays + 1)};
}

/// Each lattice has two chords, posts and both diagonals of each bay, one of them more than it
/// needs. It hangs from the one before by the end of its first chord, and leans.
nlohmann::json truss_document(const FamilyValues& values) {
  constexpr double kBay = 1.0, kDensity = 4.0, kLean = 0.3;  // m, kg/m, rad
  const int bays = values[1];
  SceneWriter scene;
  const Vector3 along = kBay * Vector3{std::sin(kLean), -std::cos(kLean), 0.0};
  const Vector3 across = kBay * Vector3{std::cos(kLean), std::sin(kLean), 0.0};
  const auto rod = [&](const std::string& a, const std::string& b, double bay_lengths) {
    scene.rod(a, b, kDensity * bay_lengths * kBay);
  };
  scene.fixed("A0", {});
  for (int lattice = 0; lattice < values[0]; ++lattice) {
    const auto A = [&](int i) {
      return numbered("A", lattice * bays + i);
    };  // the hinges among them
    const auto B = [&](int i) { return fmt::format("B{}_{}", lattice, i); };
    for (int i = 0; i <= bays; ++i) {
      const Vector3 r = double(lattice * bays + i) * along;
      if (i > 0) scene.point(A(i), r);
      scene.point(B(i), r + across);
      rod(A(i), B(i), 1.0);
      if (i == 0) continue;
      rod(A(i - 1), A(i), 1.0);
      rod(B(i - 1), B(i), 1.0);
      rod(A(i - 1), B(i), std::sqrt(2.0));
      rod(B(i - 1), A(i), std::sqrt(2.0));
    }
  }
  scene.position_output(numbered("A", values[0] * bays));
  return std::move(scene).finish();
}

}  // namespace mbs
