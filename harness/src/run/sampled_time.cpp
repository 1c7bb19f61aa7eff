// The mean of the samples stands for all later laps.
#include "run/sampled_time.hpp"

#include <algorithm>

namespace mbs {
namespace {

/// What a lap of no work seems to take, s.
double reading() {
  static const double least = [] {
    auto found = SampledTime::Clock::duration::max();
    for (int i = 0; i < 16; ++i) {
      const auto begin = SampledTime::Clock::now();
      found = std::min(found, SampledTime::Clock::now() - begin);
    }
    return std::chrono::duration<double>(found).count();
  }();
  return least;
}

}  // namespace

void SampledTime::add(double time) {
  time = std::max(0.0, time - reading());
  if (laps_ < kFirst) {
    first_ += time;
  } else {
    later_ += time;
    ++samples_;
  }
}

double SampledTime::total() const {
  if (samples_ == 0) return first_;
  return first_ + later_ / static_cast<double>(samples_) * static_cast<double>(laps_ - kFirst);
}

}  // namespace mbs
