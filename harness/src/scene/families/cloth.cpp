// Stretch fabric: threads that keep their length one way, elastic ones across.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/families/families.hpp"
#include "scene/families/scene_writer.hpp"

namespace mbs {

SceneSize cloth_size(const FamilyValues& values) {
  const long rows = values[0], columns = values[1];
  return {3 * rows * columns, rows * columns};
}

/// Warp threads are chains of rods that hang side by side. Weft threads are springs across them;
/// so are both diagonals of each cell, against shear, and what keeps the weft from bending, from
/// each thread to the one after the next. It starts bellied out, the middle more than the edges,
/// which stretches the weft.
nlohmann::json cloth_document(const FamilyValues& values) {
  constexpr double kCell = 0.25, kThreadMass = 0.1;          // m, kg between two knots
  constexpr double kLean = 0.6;                              // rad
  constexpr double kWeft = 10.0, kShear = 5.0, kBend = 2.0;  // N/m
  const int rows = values[0], columns = values[1];
  const double most = kLean * std::min(1.0, double(columns) / rows);  // or a long one is torn
  SceneWriter scene(3);
  const auto name = [](int row, int column) { return fmt::format("P{}_{}", row, column); };
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const double lean = most * std::sin(std::numbers::pi * (j + 1) / (columns + 1));
      const Vector3 down{0.0, -std::cos(lean), std::sin(lean)};
      const Vector3 r = kCell * (Vector3{double(j), 0.0, 0.0} + double(i) * down);
      if (i == 0) {
        scene.fixed(name(i, j), r);
        continue;
      }
      scene.point(name(i, j), r);
      scene.rod(name(i - 1, j), name(i, j), kThreadMass);
      if (j > 0) {
        scene.spring(name(i, j - 1), name(i, j), kWeft, kCell);
        scene.spring(name(i - 1, j - 1), name(i, j), kShear, std::numbers::sqrt2 * kCell);
        scene.spring(name(i, j - 1), name(i - 1, j), kShear, std::numbers::sqrt2 * kCell);
      }
      if (j > 1) scene.spring(name(i, j - 2), name(i, j), kBend, 2.0 * kCell);
    }
  }
  scene.position_output(name(rows, columns / 2));
  return std::move(scene).finish();
}

}  // namespace mbs
