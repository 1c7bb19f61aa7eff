// The size of a list of numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace mbs {

/// The largest |x|; 0 of none, and of NaN alone.
inline double largest_of(std::span<const double> values) {
  double largest = 0.0;
  for (const double x : values) largest = std::max(largest, std::abs(x));
  return largest;
}

}  // namespace mbs
