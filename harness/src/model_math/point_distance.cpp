// One pass over the points.
#include "model_math/point_distance.hpp"

#include <cmath>

namespace mbs {

double largest_point_distance(const Model& model, std::span<const double> x,
                              std::span<const double> y) {
  double largest = 0.0;  // squared
  for (const Point& point : model.points()) {
    if (point.is_fixed() || point.is_vector) continue;
    double squared = 0.0;
    for (int axis = 0; axis < model.dimension(); ++axis) {
      const auto i = static_cast<std::size_t>(point.offset + axis);
      squared += std::pow(x[i] - y[i], 2);
    }
    // Not std::max, which would drop a NaN.
    if (!(squared <= largest)) largest = squared;
    if (std::isnan(largest)) break;
  }
  return std::sqrt(largest);
}

}  // namespace mbs
