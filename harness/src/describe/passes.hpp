// How many passes a step takes.
#pragma once

#include <optional>

#include "mbs/implementation.hpp"
#include "scene/scene.hpp"

namespace mbs {

inline constexpr double kUnknownPasses = 2.0;  ///< where nobody can count them

/// Passes a step over the stretch that `mbs bench` times (run/stretch.hpp), or its beginning where
/// that is much work: of a factorization, as elimination.hpp counts them, there are `flops`.
/// Penalty factor and tolerance are chosen where `settings` have 0.
/// Nothing if that is too much work, or if `variant`, which serves the scene and the
/// settings, does not make a step. `smallest`: smallest_constraint_eigenvalue() at the start.
std::optional<double> count_passes(const Scene& scene, StepSettings settings,
                                   const Variant& variant, double flops, double smallest);

}  // namespace mbs
