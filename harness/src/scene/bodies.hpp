// Rods and point masses: what they add to a model's constraints, mass matrix and gravity.
#pragma once

#include <array>
#include <string>

#include "mbs/model.hpp"

namespace mbs {

/// A thin uniform rod between two points, at least one of them free.
struct Rod {
  int a = 0, b = 0;             ///< indices into ModelData::points
  double mass = 0.0;            ///< kg; 0 for a massless distance
  double squared_length = 0.0;  ///< m^2
  std::string name;
};

/// Gives every coordinate of the free points a diagonal mass entry of zero, which is
/// data.mass[coordinate], and a force of zero. Call it once, when all points are there.
void start_bodies(ModelData& data);

/// Adds the rod's distance constraint; to M, for each axis, mass/3 at its free ends and mass/6
/// between them; to Q half of its weight at each free end. `gravity` in m/s^2.
/// At most one rod between the same two points.
void add_rod(ModelData& data, Rod rod, const std::array<double, 3>& gravity);

/// Adds a point mass (kg) at a free point.
void add_point_mass(ModelData& data, int point, double mass, const std::array<double, 3>& gravity);

}  // namespace mbs
