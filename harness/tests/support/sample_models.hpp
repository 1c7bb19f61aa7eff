// Models that no scene of the program's own gives: without constraints, on a spring, and spatial.
#pragma once

#include <utility>

#include "scene/scene.hpp"

namespace mbs::test {

/// Two points in planar free fall: no constraint at all.
inline Scene free_fall() {
  ModelData data;
  data.points = {{"P", 0, {1.0, 2.0, 0.0}}, {"R", 2, {3.0, 4.0, 0.0}}};
  for (int i = 0; i < 4; ++i) data.mass.push_back({i, i, 2.0});
  data.force = {0.0, -19.62, 0.0, -19.62};
  data.initial_velocity = {1.0, 0.0, -0.5, 1.0};
  return {"free fall", Model(std::move(data)), {}, {}};
}

/// 1 kg at x (m) on a spring along x from the origin, `rest` long (m) without force; N/m, N s/m.
inline Scene oscillator(double stiffness, double damping, double rest, double x) {
  ModelData data;
  data.points = {{"A", -1, {0, 0, 0}}, {"B", 0, {x, 0, 0}}};
  data.mass = {{0, 0, 1.0}, {1, 1, 1.0}};
  data.force = data.initial_velocity = {0.0, 0.0};
  data.springs.push_back({0, 1, stiffness, damping, rest, "spring"});
  return {"oscillator", Model(std::move(data)), {}, {}};
}

/// A spherical pendulum AB with a unit vector BC at right angles to it, and a string from C to D,
/// which slides on an inclined plane. Gravity along -z; every kind of constraint, 9 variables.
inline Scene spatial_pendulum() {
  ModelData data;
  data.dimension = 3;
  data.points = {{"A", -1, {0.0, 0.0, 0.0}},
                 {"B", 0, {1.0, 0.0, 0.0}},
                 {"C", 3, {1.0, 1.0, 0.0}},
                 {"D", 6, {1.0, 2.0, -0.5}}};
  data.dot_constraints = {{1, 0, 1, 0, 1.0, "AB"},
                          {2, 1, 2, 1, 1.0, "BC"},
                          {1, 0, 2, 1, 0.0, "right angle"},
                          {3, 2, 3, 2, 1.25, "CD"}};
  data.linear_constraints = {{{{8, 1.0}, {6, 0.25}}, -0.25, "plane"}};
  for (int i = 0; i < 9; ++i) data.mass.push_back({i, i, 1.0 + 0.5 * (i / 3)});
  for (int i = 0; i < 3; ++i) data.mass.push_back({3 + i, i, 0.2});
  data.force = {0.0, 0.0, -9.81, 0.0, 0.0, -14.715, 0.0, 0.0, -19.62};
  data.initial_velocity = {0.0, 1.0, 0.0, -1.0, 1.0, 0.5, 0.0, 0.75, 0.0};
  return {"spatial pendulum", Model(std::move(data)), {}, {}};
}

}  // namespace mbs::test
