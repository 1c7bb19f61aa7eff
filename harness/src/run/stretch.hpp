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

/// Largest N up to which two correct implementations still agree beyond a singular position:
/// crossing one multiplies rounding errors, the more so the larger N.
inline constexpr int kMostLoopsToCross = 300;

/// Above it, a stretch ends this long before the singular position, s.
inline constexpr double kClearance = 0.4;

/// Steps of a stretch to be timed, of a scene with so many variables: 800, beyond 400 variables
/// 320 000 of them in all, rounded to tens, at least 40. A rule of the scene alone, so that every
/// machine is asked the same.
int most_steps(int variables);

/// The stretch of `steps` steps of `step` s. On the N-four-bar it starts on the exact motion with
/// consistent a and lambda, and is centred on the first singular position, or for N above
/// kMostLoopsToCross, and for a `scheme` that does not pass these, ends kClearance before it, with
/// fewer steps if fewer fit; clipped at t = 0.
/// Other scenes start at t = 0 and stop where a driver's table ends. `start` (s >= 0, N-four-bar
/// only) overrides. Throws UsageError, also where the stretch does not fit the scene's drivers.
Stretch make_stretch(const Scene& scene, double step, int steps,
                     std::optional<double> start = std::nullopt, Scheme scheme = Scheme::penalty);

}  // namespace mbs
