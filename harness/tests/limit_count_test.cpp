// The numbers that count: against counts by hand, and against the numbers that compute.
#include <gtest/gtest.h>

#include "limit/chain_state.hpp"
#include "limit/count.hpp"
#include "run/settings.hpp"
#include "run/stretch.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs::limit {
namespace {

constexpr Latencies kLatencies{.add = 3.0, .multiply = 5.0, .fused = 7.0, .divide = 11.0};

Counted number(double left, double right) { return make<Counted>(left, right); }

TEST(Counted, CountsOperationsOnSingleNumbersByKind) {
  Counted::latencies = kLatencies;
  Counted::operations = {};
  const Counted a = number(2.0, 3.0), b = number(5.0, 7.0);
  const Counted sum = a + b, difference = a - b, product = a * b;
  const Counted fused = fma(a, b, a), less = fnma(a, b, a), inverse = reciprocal(a);
  EXPECT_EQ(lane(sum, 1), 10.0);
  EXPECT_EQ(lane(difference, 0), -3.0);
  EXPECT_EQ(lane(product, 1), 21.0);
  EXPECT_EQ(lane(fused, 0), 12.0);
  EXPECT_EQ(lane(less, 1), -18.0);
  EXPECT_EQ(lane(inverse, 0), 0.5);
  EXPECT_EQ(lane(larger_magnitude(a, number(-9.0, 1.0)), 0), 9.0);
  const Operations& counted = Counted::operations;
  EXPECT_EQ(counted.add, 4);
  EXPECT_EQ(counted.multiply, 2);
  EXPECT_EQ(counted.fused, 4);
  EXPECT_EQ(counted.divide, 2);
  EXPECT_EQ(counted.compare, 2);
  EXPECT_EQ(counted.flops(), 4 + 2 + 2 * 4 + 2);
}

/// By hand: the longest way is a * b, + c, 1 / that.
TEST(Counted, FollowsTheLongestChain) {
  Counted::latencies = kLatencies;
  const Counted a = number(1.0, 2.0), c = number(3.0, 4.0);
  const Counted chain = reciprocal(a * a + c), beside = c + c;
  EXPECT_EQ(chain.ready, 5.0 + 3.0 + 11.0);
  EXPECT_EQ((beside * beside).ready, 3.0 + 5.0);
  EXPECT_EQ((chain + beside).ready, 19.0 + 3.0);
}

/// By hand: two fused operations, two products and two differences a lane, six numbers read.
TEST(Counted, CountsTheSubstitutionOfOneBlock) {
  Counted::latencies = kLatencies;
  Counted::operations = {};
  Factor<Counted> factor;
  factor.cx = number(1.0, 1.0);
  const Planar<Counted> found = outwards(factor, {number(1.0, 2.0), number(3.0, 4.0)});
  EXPECT_EQ(Counted::operations.fused, 2 * 2);
  EXPECT_EQ(Counted::operations.multiply, 2 * 2);
  EXPECT_EQ(Counted::operations.add, 2 * 2);
  EXPECT_EQ(Counted::operations.loaded, 6 * 16);
  EXPECT_EQ(Counted::operations.stored, 0);
  EXPECT_EQ(found.x.ready, 7.0 + 3.0);
}

struct Case {
  Scene scene;
  StepSettings settings;
  Stretch stretch;
};
Case four_bar_case(int loops) {
  Scene scene = load_scene("four-bar:" + std::to_string(loops));
  const StepSettings settings = chosen(scene.model);
  Stretch stretch = make_stretch(scene, settings.step, 10, 0.0);
  return {std::move(scene), settings, std::move(stretch)};
}

TEST(Counted, ComputesWhatPairsDo) {
  const Case given = four_bar_case(9);
  Chain<Pair> pairs(9, given.settings);
  Chain<Counted> counts(9, given.settings);
  State of_pairs = given.stretch.initial, of_counts = given.stretch.initial;
  pairs.set_state(of_pairs);
  counts.set_state(of_counts);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(pairs.step().passes, counts.step().passes);
  pairs.get_state(of_pairs);
  counts.get_state(of_counts);
  for (std::size_t i = 0; i < of_pairs.q.size(); ++i) {
    EXPECT_NEAR(of_pairs.q[i], of_counts.q[i], 1e-13);
    EXPECT_NEAR(of_pairs.v[i], of_counts.v[i], 1e-10);
  }
}

/// Two loops more put one block more into each lane: what they add is the same everywhere.
TEST(CountSteps, GrowsWithTheNumberOfLoops) {
  Count counts[3];
  for (int i = 0; i < 3; ++i) {
    const Case given = four_bar_case(10 + 2 * i);
    counts[i] = count_steps(10 + 2 * i, given.settings, given.stretch.initial, 4, kLatencies);
    EXPECT_EQ(counts[i].passes, counts[0].passes);
    EXPECT_EQ(counts[i].steps, 4);
  }
  const auto growth = [&](int i, auto field) {
    return counts[i + 1].operations.*field - counts[i].operations.*field;
  };
  for (const auto field : {&Operations::add, &Operations::multiply, &Operations::fused,
                           &Operations::compare, &Operations::loaded, &Operations::stored}) {
    EXPECT_GT(growth(0, field), 0);
    EXPECT_EQ(growth(0, field), growth(1, field));
  }
  EXPECT_EQ(growth(0, &Operations::divide), 2 * counts[0].passes);
  EXPECT_GT(counts[1].critical_path, counts[0].critical_path);
  EXPECT_EQ(counts[1].bytes - counts[0].bytes, sizeof(Block<Pair>) + sizeof(Factor<Pair>));
}

}  // namespace
}  // namespace mbs::limit
