// Who runs when, and what is made of samples that were taken side by side.
#include "bench/turns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "bench/paired_ratio.hpp"

namespace mbs {
namespace {

std::vector<Turn> all_turns(const Turns& turns, std::uint64_t seed) {
  RandomOrder random(seed);
  std::vector<Turn> result;
  take_turns(turns, random, [&](const Turn& turn) { result.push_back(turn); });
  return result;
}

TEST(PlanTurns, CutsToTheLengthOfASlice) {
  const std::vector<double> seconds{0.010, 0.020, 0.080};
  const Turns turns = plan_turns(800, seconds, 0.020, 0.005);
  EXPECT_EQ(turns.steps, 800);
  EXPECT_EQ(turns.chunk, 200);
  EXPECT_EQ(turns.count(), 4);
  EXPECT_EQ(turns.repeats, (std::vector<long>{1, 1, 1}));
}

TEST(PlanTurns, RepeatsAStretchThatIsShorterThanASlice) {
  const std::vector<double> seconds{1e-4, 1e-3, 0.02};
  const Turns turns = plan_turns(800, seconds, 1e-3, 0.005);
  EXPECT_EQ(turns.count(), 1);
  EXPECT_EQ(turns.chunk, 800);
  EXPECT_EQ(turns.repeats, (std::vector<long>{50, 5, 1}));
  // Of next to nothing, no more than the clocks can be read.
  EXPECT_EQ(plan_turns(8, std::vector<double>{0.0}, 1e-9, 0.005).repeats.front(), 5000);
}

TEST(PlanTurns, NeverCutsBelowOneStepOrOverflows) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double typical : {0.0, 1e-300, 1.0, 1e300, kInfinity}) {
    for (const double slice : {0.0, 1e-300, 1e-9, 1e6}) {
      for (const int steps : {1, 2, 7, 10'000'000}) {
        const std::vector<double> seconds{0.0, typical};
        const Turns turns = plan_turns(steps, seconds, typical, slice);
        EXPECT_GE(turns.chunk, 1);
        EXPECT_LE(turns.chunk, steps);
        EXPECT_GE(turns.count(), 1);
        EXPECT_LE(turns.count(), steps);
        for (const long repeats : turns.repeats) EXPECT_GE(repeats, 1);
        if (turns.count() > 1) {
          EXPECT_EQ(turns.repeats, (std::vector<long>{1, 1}));
        }
      }
    }
  }
  EXPECT_EQ(plan_turns(20, std::vector<double>{1.0}, 1.0, 1e-9).chunk, 1);
}

TEST(PlanTurns, WithoutALengthTakesWholeStretchesOnce) {
  const Turns turns = plan_turns(20, std::vector<double>{0.0, 1e-6, 1.0}, 1e-6, 0.0);
  EXPECT_EQ(turns.count(), 1);
  EXPECT_EQ(turns.repeats, (std::vector<long>{1, 1, 1}));
}

TEST(TakeTurns, GivesEveryContenderEveryStepOnceInTheSameChunks) {
  for (const int chunk : {1, 3, 4, 10}) {
    const Turns turns{10, chunk, {1, 1, 1, 1, 1}};
    std::map<std::size_t, int> next;  // the step that each contender comes to
    std::map<int, std::set<std::size_t>> chunks;
    int latest = 0;
    for (const Turn& turn : all_turns(turns, 7)) {
      EXPECT_EQ(turn.first, next[turn.contender]);
      EXPECT_GE(turn.first, latest) << "a chunk is done by all before the next begins";
      latest = turn.first;
      next[turn.contender] += turn.steps;
      EXPECT_TRUE(chunks[turn.first].insert(turn.contender).second);
    }
    EXPECT_EQ(static_cast<int>(chunks.size()), turns.count());
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(next[i], 10);
  }
}

TEST(TakeTurns, PassesRepeatsOn) {
  for (const Turn& turn : all_turns({10, 10, {5, 1, 8}}, 1)) {
    EXPECT_EQ(turn.repeats, std::vector<long>({5, 1, 8})[turn.contender]);
  }
}

TEST(TakeTurns, ShufflesEachChunkAnewAsTheSeedSays) {
  const Turns turns{1000, 1, {1, 1, 1}};
  const auto orders = [&turns](std::uint64_t seed) {
    std::vector<std::vector<std::size_t>> result;
    for (const Turn& turn : all_turns(turns, seed)) {
      if (result.empty() || result.back().size() == 3) result.emplace_back();
      result.back().push_back(turn.contender);
    }
    return result;
  };
  const auto first = orders(1);
  EXPECT_EQ(first, orders(1));
  EXPECT_NE(first, orders(2));
  std::map<std::vector<std::size_t>, int> counts;
  for (const auto& order : first) ++counts[order];
  ASSERT_EQ(counts.size(), 6U) << "every order occurs";
  for (const auto& [order, count] : counts) EXPECT_NEAR(count, 1000 / 6.0, 60);
}

TEST(PairedRatio, CancelsWhatSlowsBoth) {
  std::vector<double> base, times;
  for (int j = 0; j < 9; ++j) {
    base.push_back(1.0 + j);  // a machine that gets slower and slower
    times.push_back(base.back() * (1.5 + 0.01 * (j - 4)));
  }
  const PairedRatio ratio = paired_ratio(times, base);
  EXPECT_NEAR(ratio.ratio, 1.5, 1e-12);
  // P(at most 1 of 9) = 10/512 on either side.
  EXPECT_NEAR(ratio.low, 1.47, 1e-12);
  EXPECT_NEAR(ratio.high, 1.53, 1e-12);
  EXPECT_NEAR(ratio.confidence, 1 - 20.0 / 512, 1e-12);
}

TEST(PairedRatio, SaysHowLittleFewSamplesTell) {
  const std::vector<double> base{1, 1, 1}, times{3, 1, 2};
  const PairedRatio ratio = paired_ratio(times, base);
  EXPECT_EQ(ratio.ratio, 2.0);
  EXPECT_EQ(ratio.low, 1.0);
  EXPECT_EQ(ratio.high, 3.0);
  EXPECT_NEAR(ratio.confidence, 0.75, 1e-12);
  EXPECT_EQ(paired_ratio(std::vector{2.0}, std::vector{1.0}).confidence, 0.0);
}

TEST(PairedRatio, IntervalHasTheMedianOftenEnough) {
  std::vector<double> base(10'000, 1.0), times(10'000);
  for (std::size_t j = 0; j < times.size(); ++j) times[j] = static_cast<double>(j + 1);
  const PairedRatio ratio = paired_ratio(times, base);
  EXPECT_NEAR(ratio.confidence, 0.95, 0.005);
  EXPECT_NEAR(ratio.high - ratio.low, 2 * 1.96 * 50, 4);  // standard deviation sqrt(10 000)/2
}

TEST(Median, IsTheMiddle) {
  EXPECT_EQ(median({3, 1, 2}), 2.0);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
}

}  // namespace
}  // namespace mbs
