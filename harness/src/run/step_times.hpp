// How long the steps of a run took, and what of that was the machine's doing.
#pragma once

#include <optional>
#include <vector>

namespace mbs {

/// Wall clock of the steps of a run, microseconds.
struct StepTimes {
  double mean = 0.0, median = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0;
  std::optional<long> deadline_misses;  ///< steps beyond the deadline, if there is one
};

/// Nearest-rank quantiles of `us`, which it reorders.
StepTimes step_times(std::vector<float>& us, std::optional<double> deadline_us);

}  // namespace mbs
