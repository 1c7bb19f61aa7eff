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

std::vector<ShortLink> short_links(const Model& model, double length) {
  constexpr double kShorter = 1 - 1e-6;  // not only by rounding: links of one length are many
  const std::vector<double> of_part = part_lengths(model);
  std::vector<ShortLink> result;
  for (const DotConstraint& c : model.dot_constraints()) {
    const auto a = static_cast<std::size_t>(c.a), b = static_cast<std::size_t>(c.b);
    const Point &from = model.points()[a], &to = model.points()[b];
    if (!c.is_distance() || from.is_vector || to.is_vector) continue;
    const Vector3 d = to.position - from.position;
    const double its = std::sqrt(dot(d, d));
    const double shortest = std::min({length, of_part[a], of_part[b]});
    if (its > 0.0 && its < kShorter * shortest) result.push_back({&c, its});
  }
  return result;
}

}  // namespace mbs
