// How long a model's drivers are known.
#pragma once

#include "mbs/model.hpp"

namespace mbs {

/// Last time at which all drivers are known, s; infinite unless one is tabulated.
double driver_end(const Model& model);

/// Throws UsageError if a run until `end` (s) goes beyond it by more than the rounding of time.
void require_drivers_until(const Model& model, double end);

}  // namespace mbs
