// Forces and torques of constraints from their multipliers.
#pragma once

#include "run/scene_motion.hpp"

namespace mbs {

/// Output::Force other than vector: N, N m, or that of a multiplier. `motion` is at `state`.
double constraint_scalar(const Scene& scene, const SceneMotion& motion, const State& state,
                         const Output& output);

/// Output::Force::vector, N.
Vector3 constraint_vector(const Scene& scene, const SceneMotion& motion, const State& state,
                          const Output& output);

}  // namespace mbs
