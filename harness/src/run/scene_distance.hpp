// How far apart two vectors of coordinates, or of their derivatives, are: point by point.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model_math/vector3.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// Calls `take` with what each of `of` is at each point: the free ones, then the points of bodies
/// that are no coordinates; a unit vector counts as if it were `length` (m) long. `of` gives, by
/// number, entries of a difference of two vectors of coordinates, or of their derivatives: driven
/// points are where they are in both.
template <class Take, class... Of>
void for_each_point(const Scene& scene, double length, Take take, Of... of) {
  const Model& model = scene.model;
  const bool is_spatial = model.dimension() == 3;
  const auto at = [is_spatial](const Point& point, const auto& entry) {
    const auto i = static_cast<std::size_t>(point.offset);
    return Vector3{entry(i), entry(i + 1), is_spatial ? entry(i + 2) : 0.0};
  };
  for (const Point& point : model.points()) {
    const double size = point.is_vector ? length : 1.0;
    if (!point.is_fixed()) take(size * at(point, of)...);
  }
  for (const Marker& marker : scene.elements.markers) {  // linear in the points
    const double size = marker.is_vector ? length : 1.0;
    const auto sum = [&](const auto& entry) {
      Vector3 x{};
      for (const Marker::Part& part : marker.parts) {
        const Point& point = model.points()[static_cast<std::size_t>(part.point)];
        if (!point.is_fixed()) x = x + multiply(part.matrix, at(point, entry));
      }
      return x;
    };
    take(size * sum(of)...);
  }
}

/// What errors of these points are small against, in their order, m: `length`, or that of their own
/// part if it is shorter (part_lengths()); `length` for unit vectors.
std::vector<double> lengths_of_points(const Scene& scene, double length);

}  // namespace mbs
