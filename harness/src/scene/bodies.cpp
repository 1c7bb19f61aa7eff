// Bodies in natural coordinates; M and Q are constant.
#include "scene/bodies.hpp"

#include <algorithm>
#include <utility>

namespace mbs {
namespace {

const Point& point_at(const ModelData& data, int index) {
  return data.points[static_cast<std::size_t>(index)];
}

/// Adds `inertia` to the diagonal of M and the weight of `weighing` to Q, on every axis of a point.
void load_point(ModelData& data, int index, double inertia, double weighing,
                const std::array<double, 3>& gravity) {
  const Point& point = point_at(data, index);
  if (point.is_fixed()) return;
  for (int axis = 0; axis < data.dimension; ++axis) {
    const auto coordinate = static_cast<std::size_t>(point.offset + axis);
    data.mass[coordinate].value += inertia;
    data.force[coordinate] += weighing * gravity[static_cast<std::size_t>(axis)];
  }
}

}  // namespace

void start_bodies(ModelData& data) {
  const auto free_points = std::count_if(data.points.begin(), data.points.end(),
                                         [](const Point& point) { return !point.is_fixed(); });
  const int variables = data.dimension * static_cast<int>(free_points);
  for (int i = 0; i < variables; ++i) data.mass.push_back({i, i, 0.0});
  data.force.assign(static_cast<std::size_t>(variables), 0.0);
}

void add_rod(ModelData& data, Rod rod, const std::array<double, 3>& gravity) {
  load_point(data, rod.a, rod.mass / 3.0, rod.mass / 2.0, gravity);
  load_point(data, rod.b, rod.mass / 3.0, rod.mass / 2.0, gravity);
  const Point& a = point_at(data, rod.a);
  const Point& b = point_at(data, rod.b);
  if (rod.mass > 0.0 && !a.is_fixed() && !b.is_fixed()) {
    for (int axis = 0; axis < data.dimension; ++axis) {
      const auto [col, row] = std::minmax({a.offset + axis, b.offset + axis});
      data.mass.push_back({row, col, rod.mass / 6.0});
    }
  }
  data.dot_constraints.push_back(
      {rod.a, rod.b, rod.a, rod.b, rod.squared_length, std::move(rod.name)});
}

void add_point_mass(ModelData& data, int point, double mass, const std::array<double, 3>& gravity) {
  load_point(data, point, mass, mass, gravity);
}

}  // namespace mbs
