// Quantiles by selection: runs have millions of steps.
#include "run/step_times.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mbs {
namespace {

double quantile(std::vector<float>& values, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share * values.size())) - 1;
  const auto nth = values.begin() + std::max<std::ptrdiff_t>(rank, 0);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace

StepTimes step_times(std::vector<float>& us, std::optional<double> deadline_us) {
  StepTimes result;
  if (deadline_us) {
    result.deadline_misses =
        std::ranges::count_if(us, [&](float time) { return time > *deadline_us; });
  }
  if (us.empty()) return result;
  result.mean = std::accumulate(us.begin(), us.end(), 0.0) / static_cast<double>(us.size());
  result.median = quantile(us, 0.5);
  result.p99 = quantile(us, 0.99);
  result.p999 = quantile(us, 0.999);
  result.max = quantile(us, 1.0);
  return result;
}

}  // namespace mbs
