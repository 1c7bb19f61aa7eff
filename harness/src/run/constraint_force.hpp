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

/// How much of the largest constraint force or load at `state` rounding of the coordinates may make
/// in the penalty form: alpha |Phi_q|^2 eps max|q| over |Phi_q| |lambda| or |Q|, each the largest.
/// 0 where nothing acts.
double rounding_of_penalty_forces(const Model& model, double penalty, const State& state);

}  // namespace mbs
