// How far apart two vectors of coordinates, or of their derivatives, are: point by point.
#pragma once

#include <span>

#include "scene/scene.hpp"

namespace mbs {

/// Largest |x_p - y_p| over the free points p and the points of bodies that are no coordinates, in
/// the unit of x; a unit vector counts as if it were `length` (m) long. NaN if one is. x, y: n, of
/// the same instant.
double largest_distance(const Scene& scene, double length, std::span<const double> x,
                        std::span<const double> y);

}  // namespace mbs
