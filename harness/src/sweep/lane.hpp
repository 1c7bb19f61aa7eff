// One parameter set of a sweep and what became of it.
#pragma once

#include <span>
#include <vector>

#include "run/run.hpp"
#include "sweep/output_extremes.hpp"

namespace mbs {

struct Lane {
  Scene scene;
  RunSettings settings;
  RunSummary summary = {};             ///< without times
  std::vector<Extremes> outputs = {};  ///< empty where the run did not come to its end
};

/// Whether the two may be lanes of one batch.
bool fit_one_batch(const Lane& a, const Lane& b);

/// Runs lanes of which each fits the first: side by side where `variant` takes them so, else one
/// after the other. Each has the outcome that run() would give it alone. Settings must be in range,
/// as require_duration() has it. Returns whether they ran side by side.
bool run_lanes(std::span<Lane> lanes, const Variant& variant);

/// As many as `variant` is best given at once.
std::size_t lanes_at_once(const Variant& variant);

}  // namespace mbs
