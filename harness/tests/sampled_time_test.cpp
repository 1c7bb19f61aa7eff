// What short laps take together, from samples of them.
#include "run/sampled_time.hpp"

#include <gtest/gtest.h>

namespace mbs {
namespace {

/// Laps of no work, the first of which took `first` (s) and the others `other`.
double sampled(int laps, double first, double other) {
  SampledTime time;
  for (int lap = 0; lap < laps; ++lap) {
    time.begin();
    time.end(lap == 0 ? -first : -other);  // so much less than nothing was something else
  }
  return time.total();
}

TEST(SampledTime, StandsForAllLapsButCountsTheFirstOnce) {
  constexpr double kLittle = 1.0;  // s, for interruptions
  EXPECT_EQ(SampledTime().total(), 0.0);
  for (const int laps : {1, 2, 16, 17, 18, 100, 1000}) {
    EXPECT_NEAR(sampled(laps, 1e5, 1e3), 1e5 + 1e3 * (laps - 1), kLittle) << laps;
  }
}

TEST(SampledTime, SamplesNoLapsThatComeBackRegularly) {
  constexpr int kLaps = 4000;
  for (const int period : {2, 3, 4, 8, 16}) {
    SampledTime time;
    for (int lap = 0; lap < kLaps; ++lap) {
      time.begin();
      time.end(lap % period == 1 ? -1e3 : 0.0);
    }
    EXPECT_NEAR(time.total() * period / (1e3 * kLaps), 1.0, 0.1) << period;
  }
}

}  // namespace
}  // namespace mbs
