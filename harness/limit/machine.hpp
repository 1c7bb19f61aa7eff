// What the machine can do at best, measured: latencies, rate of arithmetic, bandwidth of each
// level.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "limit/counted.hpp"

namespace mbs::limit {

/// One level of the memory hierarchy.
struct Level {
  std::string name;        ///< "L1", "L2", "L3" or "memory"
  std::size_t bytes = 0;   ///< capacity; the largest number there is for "memory"
  double bandwidth = 0.0;  ///< bytes/ns, loads and stores together
};

struct Machine {
  Latencies latencies;     ///< of pairs, ns
  int vector_bytes = 0;    ///< of the widest vectors of this build
  double peak = 0.0;       ///< flops/ns of fused operations in the widest vectors of this build
  double divisions = 0.0;  ///< divisions/ns of single numbers, likewise
  std::vector<Level> levels;

  /// The first level that holds `bytes`.
  [[nodiscard]] const Level& level_of(std::size_t bytes) const;
};

/// Takes about half a second. Each figure is the best of many short runs: a limit, not an average.
Machine measure_machine();

}  // namespace mbs::limit
