// The stretch of the motion over which implementations are checked and timed.
#pragma once

#include <optional>

#include "mbs/simulation.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// A number of steps from a given state.
struct Stretch {
  double start = 0.0;  ///< s
  int steps = 0;
  State initial;
};

/// The stretch of `steps` steps of `step` s. On the N-four-bar it is centred on the first singular
/// position, clipped at t = 0, and starts on the exact motion with consistent a and lambda; other
/// scenes start at t = 0. `start` (s >= 0, N-four-bar only) overrides. Throws UsageError.
Stretch make_stretch(const Scene& scene, double step, int steps,
                     std::optional<double> start = std::nullopt);

}  // namespace mbs
