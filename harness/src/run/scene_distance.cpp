// The largest of one pass over the points.
#include "run/scene_distance.hpp"

#include <cmath>

namespace mbs {

double largest_distance(const Scene& scene, double length, std::span<const double> x,
                        std::span<const double> y) {
  double largest = 0.0;  // squared
  for_each_point(
      scene, length,
      [&](const Vector3& d) {
        const double squared = dot(d, d);
        // Not std::max, which would drop a NaN.
        if (!(squared <= largest) && !std::isnan(largest)) largest = squared;
      },
      [&](std::size_t i) { return x[i] - y[i]; });
  return std::sqrt(largest);
}

}  // namespace mbs
