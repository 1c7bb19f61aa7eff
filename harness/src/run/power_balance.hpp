// Energy against the work of drivers, dampers and forces, over single steps.
#pragma once

#include <vector>

#include "mbs/simulation.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// What the energy of a model changes by, and what does it: with E = v.M v / 2 + V, V of the
/// constant forces and of springs and laws between points that no driver moves,
///
///   E' = (Q - Q_V) . v + lambda . Phi_t,     Q_V = -dV/dq,
///
/// since Phi_q v = -Phi_t: what dampers, couples, laws and driven mass do, and what drivers do by
/// the constraints. Over a step the trapezoidal rule is exact to (omega dt)^3.
class PowerBalance {
 public:
  /// `scene` must outlive this.
  explicit PowerBalance(const Scene& scene);

  struct Step {
    double excess = 0.0;  ///< change of E less the work done, J
    double work = 0.0;    ///< its size, J
  };
  /// Over the step of `step` (s) from `before` to `after`, which is at `t` (s).
  [[nodiscard]] Step over(const State& before, const State& after, double t, double step);

  /// The share of the kinetic energy that dampers, and what else depends on velocities, take from
  /// `state` at `t` (s), 1/s; 0 where they bring some.
  [[nodiscard]] double braked(double t, const State& state);

 private:
  struct Instant {
    double energy = 0.0;  // J
    double power = 0.0;   // W
  };
  [[nodiscard]] Instant at(double t, const State& state);

  const Model& model_;
  Model conserving_;  // what has V alone
  std::vector<double> force_, conserved_, rate_, rest_;
};

}  // namespace mbs
