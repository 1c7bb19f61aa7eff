// How long a scene's drivers are known, in range and resolved by the steps.
#pragma once

#include "mbs/model.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// Last time at which all drivers are known, s; infinite unless one is tabulated.
double driver_end(const Model& model);

/// Throws UsageError if a run of so many steps of `step` (s) goes beyond it by more than the
/// rounding of time, or if at any of the steps a driver's value leaves its range or changes too
/// fast for them.
void require_drivers(const Scene& scene, double step, long steps);

}  // namespace mbs
