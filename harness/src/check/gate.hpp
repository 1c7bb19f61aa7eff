// The agreement gate: what an implementation must pass before it may be timed.
#pragma once

#include "check/reference_run.hpp"
#include "check/verdict.hpp"
#include "registry/registry.hpp"
#include "run/isolate.hpp"

namespace mbs {

/// Checks `variant` on `scene` in a child process under `limits`: lock-step, free-running motion
/// and number of passes against `reference`, the same of batches, then error and order against the
/// exact solution if there is one. A dead or hanging child is a verdict, not an error.
Verdict check_implementation(const Scene& scene, const NamedVariant& variant,
                             const StepSettings& settings, const ReferenceRun& reference,
                             const IsolationLimits& limits = {});

/// The same in this process, which a fault ends and a hang stops: for tests, whose short checks take
/// less time than a process each. `seconds` of processor time are what each check is cut to.
Verdict check_in_process(const Scene& scene, const NamedVariant& variant,
                         const StepSettings& settings, const ReferenceRun& reference,
                         double seconds = IsolationLimits{}.seconds);

}  // namespace mbs
