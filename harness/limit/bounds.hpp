// From what a step consists of and what the machine can do: the time that it cannot do without.
#pragma once

#include <algorithm>

#include "limit/count.hpp"
#include "limit/machine.hpp"

namespace mbs::limit {

/// Lower bounds of one step, ns.
struct Bounds {
  double arithmetic = 0.0;  ///< every operation at the machine's full rate
  double latency = 0.0;     ///< the longest chain of operations that need each other
  double memory = 0.0;      ///< every load and store at the bandwidth of the level that holds them

  [[nodiscard]] double least() const { return std::max({arithmetic, latency, memory}); }
};

inline Bounds bounds_of(const Count& count, const Machine& machine) {
  const Operations& done = count.operations;
  const auto steps = static_cast<double>(count.steps);
  const double flops = static_cast<double>(done.flops()) / machine.peak;
  const double divisions = static_cast<double>(done.divide) / machine.divisions;
  const double bytes = static_cast<double>(done.loaded + done.stored);
  return {std::max(flops, divisions) / steps, count.critical_path / steps,
          bytes / machine.level_of(count.bytes).bandwidth / steps};
}

}  // namespace mbs::limit
