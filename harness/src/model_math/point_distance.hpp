// How far apart two vectors of coordinates, or of their derivatives, are: point by point.
#pragma once

#include <span>

#include "mbs/model.hpp"

namespace mbs {

/// Largest |x_p - y_p| over the free points p (not over unit vectors), in the unit of x; NaN if one
/// is. x, y: n.
double largest_point_distance(const Model& model, std::span<const double> x,
                              std::span<const double> y);

}  // namespace mbs
