// One pass over the points, then one over the markers, which are linear in them.
#include "run/scene_distance.hpp"

#include <cmath>

#include "model_math/vector3.hpp"

namespace mbs {

double largest_distance(const Scene& scene, double length, std::span<const double> x,
                        std::span<const double> y) {
  const Model& model = scene.model;
  const auto difference = [&](const Point& point) {
    Vector3 d{};
    if (point.is_fixed()) return d;  // also driven ones are where they are in both
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(model.dimension()); ++axis) {
      const std::size_t i = static_cast<std::size_t>(point.offset) + axis;
      d[axis] = x[i] - y[i];
    }
    return d;
  };
  double largest = 0.0;  // squared
  const auto take = [&](const Vector3& d, bool is_vector) {
    const double squared = dot(d, d) * (is_vector ? length * length : 1.0);
    // Not std::max, which would drop a NaN.
    if (!(squared <= largest) && !std::isnan(largest)) largest = squared;
  };
  for (const Point& point : model.points()) take(difference(point), point.is_vector);
  for (const Marker& marker : scene.elements.markers) {
    Vector3 d{};
    for (const Marker::Part& part : marker.parts) {
      const Point& point = model.points()[static_cast<std::size_t>(part.point)];
      d = d + multiply(part.matrix, difference(point));
    }
    take(d, marker.is_vector);
  }
  return std::sqrt(largest);
}

}  // namespace mbs
