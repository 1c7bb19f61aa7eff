// How far apart two vectors of coordinates, or of their derivatives, are: point by point.
#pragma once

#include <span>
#include <vector>

#include "model_math/vector3.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// What a difference of two vectors of coordinates, or of their derivatives, is at each point: the
/// free ones, then the points of bodies that are no coordinates; a unit vector counts as if it were
/// `length` (m) long. x: n, in the unit of the result; driven points are where they are in both.
void point_vectors(const Scene& scene, double length, std::span<const double> x,
                   std::vector<Vector3>& result);

/// Largest |x_p - y_p| over these points, in the unit of x. NaN if one is. x, y: n, of the same
/// instant.
double largest_distance(const Scene& scene, double length, std::span<const double> x,
                        std::span<const double> y);

}  // namespace mbs
