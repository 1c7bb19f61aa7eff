// Passes over the points.
#include "run/scene_distance.hpp"

#include <algorithm>
#include <cmath>

#include "model_math/turning.hpp"

namespace mbs {

std::vector<double> lengths_of_points(const Scene& scene, double length) {
  const std::vector<double> of_part = part_lengths(scene.model);
  std::vector<double> result;
  for (std::size_t k = 0; k < of_part.size(); ++k) {
    const Point& point = scene.model.points()[k];
    if (point.is_fixed()) continue;
    result.push_back(point.is_vector ? length : std::min(length, of_part[k]));
  }
  for (const Marker& marker : scene.elements.markers) {
    result.push_back(length);
    if (marker.is_vector) continue;
    for (const Marker::Part& part : marker.parts) {
      result.back() = std::min(result.back(), of_part[static_cast<std::size_t>(part.point)]);
    }
  }
  return result;
}

}  // namespace mbs
