// Checks against the exact motion of the N-four-bar: size of the error and order of convergence.
#pragma once

#include <vector>

#include "check/verdict.hpp"
#include "mbs/implementation.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// "exact": position error up to 0.6 s at most 0.65 m/s^2 dt^2 (RATTLE: 1.45);
/// "convergence-order": 2.0 +- 0.1 over the steps 4 dt, 2 dt, dt with alpha dt^2 fixed and the
/// tolerance falling as dt^4. Both stop before the first singular position. Not run, saying so, if
/// the step or another setting lets no second order be seen.
std::vector<Check> exact_checks(const Scene& scene, const Variant& variant,
                                const StepSettings& settings);

/// The same checks, kept visible as not run.
std::vector<Check> exact_checks_not_run(const std::string& reason);

}  // namespace mbs
