// What a step of the chain consists of, counted by running it.
#pragma once

#include <cstddef>

#include "limit/counted.hpp"
#include "mbs/simulation.hpp"

namespace mbs::limit {

/// Over a number of steps.
struct Count {
  Operations operations;
  double critical_path = 0.0;  ///< ns; the longest chain of operations that need each other
  long passes = 0;
  long steps = 0;
  std::size_t bytes = 0;  ///< what a step goes through: state and factors
};

/// Runs `steps` steps of the N-four-bar from `initial` in numbers that count, with `latencies`.
Count count_steps(int loops, const StepSettings& settings, const State& initial, long steps,
                  const Latencies& latencies);

}  // namespace mbs::limit
