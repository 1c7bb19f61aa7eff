// One pass over the points, then one over the markers, which are linear in them.
#include "run/scene_distance.hpp"

#include <cmath>

namespace mbs {
namespace {

/// Gives `take` the vector at each point; `of` is a coordinate's number.
template <class Of, class Take>
void for_each_point(const Scene& scene, double length, Of of, Take take) {
  const Model& model = scene.model;
  const auto at = [&](const Point& point) {
    Vector3 x{};
    if (point.is_fixed()) return x;  // also driven ones are where they are in both
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(model.dimension()); ++axis) {
      x[axis] = of(static_cast<std::size_t>(point.offset) + axis);
    }
    return x;
  };
  const auto give = [&](const Vector3& x, bool is_vector) { take(is_vector ? length * x : x); };
  for (const Point& point : model.points()) {
    if (!point.is_fixed()) give(at(point), point.is_vector);
  }
  for (const Marker& marker : scene.elements.markers) {
    Vector3 x{};
    for (const Marker::Part& part : marker.parts) {
      const Point& point = model.points()[static_cast<std::size_t>(part.point)];
      x = x + multiply(part.matrix, at(point));
    }
    give(x, marker.is_vector);
  }
}

}  // namespace

void point_vectors(const Scene& scene, double length, std::span<const double> x,
                   std::vector<Vector3>& result) {
  result.clear();
  for_each_point(
      scene, length, [&](std::size_t i) { return x[i]; },
      [&](const Vector3& vector) { result.push_back(vector); });
}

double largest_distance(const Scene& scene, double length, std::span<const double> x,
                        std::span<const double> y) {
  double largest = 0.0;  // squared
  for_each_point(
      scene, length, [&](std::size_t i) { return x[i] - y[i]; },
      [&](const Vector3& d) {
        const double squared = dot(d, d);
        // Not std::max, which would drop a NaN.
        if (!(squared <= largest) && !std::isnan(largest)) largest = squared;
      });
  return std::sqrt(largest);
}

}  // namespace mbs
