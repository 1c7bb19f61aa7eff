// The mean of the samples stands for all later laps.
#include "run/sampled_time.hpp"

#include <algorithm>
#include <limits>

namespace mbs {
namespace {

/// What a lap of no work seems to take on average, s: the least of single ones would be too little
/// where the clock goes in steps of 10 ns.
double reading() {
  static const double least = [] {
    constexpr int kTimes = 8, kReadings = 16;
    double found = std::numeric_limits<double>::infinity();  // without interruptions
    for (int i = 0; i < kTimes; ++i) {
      const auto begin = SampledTime::Clock::now();
      auto end = begin;
      for (int j = 0; j < kReadings; ++j) end = SampledTime::Clock::now();
      found = std::min(found, std::chrono::duration<double>(end - begin).count() / kReadings);
    }
    return found;
  }();
  return least;
}

}  // namespace

void SampledTime::add(double time) {
  time -= reading();  // of a short lap it may be below 0, which others make up for
  if (laps_ < kFirst) {
    first_ += time;
  } else {
    later_ += time;
    ++samples_;
  }
}

double SampledTime::total() const {
  if (samples_ == 0) return std::max(0.0, first_);
  const double later = later_ / static_cast<double>(samples_);
  return std::max(0.0, first_ + later * static_cast<double>(laps_ - kFirst));
}

}  // namespace mbs
