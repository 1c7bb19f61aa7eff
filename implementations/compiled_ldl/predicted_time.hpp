// The predicted time of a factorization: what its fronts take, and which of them wait for which.
#pragma once

#include <vector>

namespace mbs::compiled_ldl {

/// Cycles in which a front keeps the processor busy, and those in which what depends on it waits
/// while fronts next to it that do not may go on.
struct FrontTime {
  double work = 0.0, latency = 0.0;
};

/// Of a front with `pivots` columns and `border` more rows, which are those of `nodes` nodes.
/// `width`: how many numbers a processor handles at once.
FrontTime front_time(int pivots, int border, int nodes, int width);

/// Of fronts one after the other; `parents`: which later front waits for each, -1: none.
double predicted_cycles(const std::vector<FrontTime>& fronts, const std::vector<int>& parents);

}  // namespace mbs::compiled_ldl
