// Sorts ratios and counts binomially.
#include "bench/paired_ratio.hpp"

#include <algorithm>
#include <cmath>

namespace mbs {

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

PairedRatio paired_ratio(std::span<const double> times, std::span<const double> base) {
  const std::size_t count = times.size();
  std::vector<double> ratios(count);
  for (std::size_t j = 0; j < count; ++j) ratios[j] = times[j] / base[j];
  std::ranges::sort(ratios);
  // tail: the chance that at most `cut` of the ratios lie below the median. Long double has room
  // for 2^-10000.
  long double term = std::pow(0.5L, static_cast<long double>(count)), tail = term;
  std::size_t cut = 0;
  while (2 * (cut + 1) < count) {
    term *= static_cast<long double>(count - cut) / static_cast<long double>(cut + 1);
    if (2 * (tail + term) > 0.05L) break;
    tail += term;
    ++cut;
  }
  return {median(ratios), ratios[cut], ratios[count - 1 - cut],
          std::max(0.0, static_cast<double>(1 - 2 * tail))};
}

}  // namespace mbs
