#include "model_math/extent.hpp"

#include <algorithm>
#include <limits>

namespace mbs {

double extent(std::span<const Point> points) {
  double largest = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Point& point : points) {
      if (point.is_vector) continue;
      low = std::min(low, point.position[axis]);
      high = std::max(high, point.position[axis]);
    }
    largest = std::max(largest, high - low);
  }
  return largest > 0.0 ? largest : 1.0;
}

}  // namespace mbs
