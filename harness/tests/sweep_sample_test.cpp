// Random values: what they are, and that they are the same again.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "support/scene_support.hpp"
#include "sweep/sample.hpp"

namespace mbs {
namespace {

constexpr Distribution kUniform{Distribution::Kind::uniform, 2.0, 4.0};
constexpr Distribution kNormal{Distribution::Kind::normal, -1.0, 0.5};

std::vector<std::vector<double>> draw(const std::vector<Distribution>& distributions,
                                      const Sampling& sampling) {
  auto values = draw_shares(distributions.size(), sampling);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (double& value : values[i]) value = value_at(distributions[i], value);
  }
  return values;
}

struct Moments {
  double mean = 0.0, deviation = 0.0;
};

Moments moments(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double x : values) sum += x;
  const double mean = sum / static_cast<double>(values.size());
  for (const double x : values) squares += (x - mean) * (x - mean);
  return {mean, std::sqrt(squares / static_cast<double>(values.size()))};
}

TEST(SweepSample, HasTheDistributions) {
  for (const bool sobol : {false, true}) {
    const auto values = draw({kUniform, kNormal}, {4096, 7, sobol});
    ASSERT_EQ(values.size(), 2U);
    ASSERT_EQ(values[0].size(), 4096U);
    const Moments uniform = moments(values[0]), normal = moments(values[1]);
    EXPECT_NEAR(uniform.mean, 3.0, 0.03);
    EXPECT_NEAR(uniform.deviation, 2.0 / std::sqrt(12.0), 0.02);
    EXPECT_NEAR(normal.mean, -1.0, 0.03);
    EXPECT_NEAR(normal.deviation, 0.5, 0.02);
    for (const double x : values[0]) EXPECT_TRUE(x > 2.0 && x < 4.0);
  }
}

TEST(SweepSample, NeverDrawsAnEnd) {
  EXPECT_GT(random_share(0), 0.0);
  EXPECT_LT(random_share(~std::uint64_t{0}), 1.0);
}

TEST(SweepSample, BelongsToItsSeed) {
  for (const bool sobol : {false, true}) {
    EXPECT_EQ(draw({kUniform}, {10, 3, sobol}), draw({kUniform}, {10, 3, sobol}));
    EXPECT_NE(draw({kUniform}, {10, 3, sobol}), draw({kUniform}, {10, 4, sobol}));
  }
}

/// Of 2^k points of a Sobol sequence, also of a shifted one, each interval of length 2^-k has one.
TEST(SweepSample, SobolIsEven) {
  for (const long count : {1, 8, 64}) {
    for (const std::uint64_t seed : {1, 11}) {
      const auto values = draw({kUniform, kUniform, kUniform}, {count, seed, true});
      for (const std::vector<double>& axis : values) {
        std::set<long> cells;
        for (const double x : axis) {
          cells.insert(static_cast<long>((x - 2.0) / 2.0 * static_cast<double>(count)));
        }
        EXPECT_EQ(cells.size(), static_cast<std::size_t>(count)) << seed;
      }
    }
  }
}

/// In the plane of the first two numbers, each square of 1/8 by 1/8 has one of 64 points.
TEST(SweepSample, SobolIsEvenInThePlane) {
  const auto values = draw({kUniform, kUniform}, {64, 3, true});
  std::set<std::pair<int, int>> squares;
  for (std::size_t i = 0; i < 64; ++i) {
    squares.emplace(static_cast<int>((values[0][i] - 2.0) * 4),
                    static_cast<int>((values[1][i] - 2.0) * 4));
  }
  EXPECT_EQ(squares.size(), 64U);
}

TEST(SweepSample, ReadsDistributions) {
  const auto uniform = parse_distribution("uniform:-1:2.5", "p");
  ASSERT_TRUE(uniform);
  EXPECT_EQ(uniform->first, -1.0);
  EXPECT_EQ(uniform->second, 2.5);
  EXPECT_EQ(parse_distribution("normal:3:0.1", "p")->kind, Distribution::Kind::normal);
  EXPECT_FALSE(parse_distribution("1:2:3", "p"));
  for (const char* text : {"uniform:1", "uniform:2:1", "uniform:1:1", "uniform:a:1", "normal:1:0",
                           "normal:1:-1", "normal:1", "uniform:1:2:3"}) {
    EXPECT_THROW(parse_distribution(text, "p"), UsageError) << text;
  }
}

}  // namespace
}  // namespace mbs
