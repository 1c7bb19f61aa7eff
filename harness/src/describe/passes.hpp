// How many passes a step takes, from how accelerations change at the start.
#pragma once

#include "mbs/simulation.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// Passes a step, a mean of the first kPassSteps.
struct Passes {
  double penalty = 2.0, saddle_point = 2.0;  ///< of the forms; 2 where nothing is known
};

inline constexpr int kPassSteps = 100;

/// With the step of `settings`, and penalty factor and tolerance as they are chosen without being
/// asked for; `smallest`: smallest_constraint_eigenvalue() at the start. README.md here says how.
/// Takes three factorizations of the saddle-point matrix.
Passes expected_passes(const Scene& scene, double smallest, const StepSettings& settings);

}  // namespace mbs
