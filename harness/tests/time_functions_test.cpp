// Drivers: values, derivatives, and what counts as a corner.
#include "scene/time_functions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace mbs {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Rate and acceleration against central differences.
void expect_derivatives(const TimeFunction& f, double t) {
  const double h = 1e-4;
  const double before = f.at(t - h).value, at = f.at(t).value, after = f.at(t + h).value;
  const double scale = 1.0 + std::abs(f.at(t).acceleration);
  EXPECT_NEAR(f.at(t).rate, (after - before) / (2 * h), 1e-5 * scale) << t;
  EXPECT_NEAR(f.at(t).acceleration, (after - 2 * at + before) / (h * h), 1e-3 * scale) << t;
}

std::vector<double> steps(int count, double h, double from = 0.0) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(from + i * h);
  return times;
}

template <typename F>
std::vector<double> sampled(const std::vector<double>& times, F f) {
  std::vector<double> values;
  for (const double t : times) values.push_back(f(t));
  return values;
}

TEST(TimeFunctions, PolynomialAndSine) {
  const TimeFunction f = polynomial({1, -2, 3, 0.5});
  EXPECT_DOUBLE_EQ(f.at(2.0).value, 1 - 4 + 12 + 4);
  EXPECT_DOUBLE_EQ(f.at(2.0).rate, -2 + 12 + 6);
  EXPECT_DOUBLE_EQ(f.at(2.0).acceleration, 6 + 6);
  const TimeFunction s = sine({2.0, 0.5, 0.25 * std::numbers::pi, 1.0});
  EXPECT_DOUBLE_EQ(s.at(0.0).value, 1.0 + std::sqrt(2.0));
  for (const double t : {-0.3, 0.0, 1.7}) {
    expect_derivatives(f, t);
    expect_derivatives(s, t);
  }
  EXPECT_EQ(s.end(), kInfinite);
}

TEST(TimeFunctions, SplineIsNaturalAndGoesOnStraight) {
  const std::vector<double> times{-1, 0, 0.5, 2, 3};
  const std::vector<double> values{0, 1, 0, 2, -1};
  const TimeFunction f = spline(times, values);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(f.at(times[i]).value, values[i], 1e-14);
  }
  EXPECT_NEAR(f.at(-1.0).acceleration, 0.0, 1e-14);
  EXPECT_NEAR(f.at(3.0).acceleration, 0.0, 1e-13);
  for (const double t : {-2.0, -0.4, 0.2, 1.1, 2.9, 4.0}) expect_derivatives(f, t);
  for (const double t : times) {  // twice continuously differentiable
    EXPECT_NEAR(f.at(t - 1e-9).rate, f.at(t + 1e-9).rate, 1e-6);
    EXPECT_NEAR(f.at(t - 1e-9).acceleration, f.at(t + 1e-9).acceleration, 1e-6);
  }
  EXPECT_EQ(f.end(), 3.0);
}

TEST(TimeFunctions, SplineReproducesStraightLinesAndConverges) {
  const TimeFunction line = spline({0, 1, 5, 6}, {1, 3, 11, 13});
  EXPECT_NEAR(line.at(3.3).value, 7.6, 1e-14);
  EXPECT_NEAR(line.at(3.3).acceleration, 0.0, 1e-14);
  const auto f = [](double t) { return std::sin(t); };
  const auto error = [&](int rows) {
    const auto times = steps(rows, std::numbers::pi / (rows - 1));
    return std::abs(spline(times, sampled(times, f)).at(1.0).value - std::sin(1.0));
  };
  EXPECT_LT(error(41), error(21) / 10);  // fourth order: 16
}

TEST(TimeFunctions, Composites) {
  const TimeFunction angle = polynomial({0.2, 1.5, -0.3});
  const TimeFunction cosine = cosine_of(angle, 2.0, 0.4);
  EXPECT_DOUBLE_EQ(cosine.at(0.0).value, 2.0 * std::cos(0.6));
  const TimeFunction square = square_of(angle);
  const TimeFunction sum = combination({{2.0, angle}, {-1.0, square}, {3.0, 4.0}}, 5.0);
  EXPECT_DOUBLE_EQ(sum.at(0.0).value, 0.4 - 0.04 + 17.0);
  for (const double t : {0.0, 1.3}) {
    for (const TimeFunction& f : {cosine, square, sum}) expect_derivatives(f, t);
  }
  const TimeFunction table = spline({0, 1, 2, 3}, {0, 1, 2, 3});
  for (const TimeFunction& f :
       {cosine_of(table, 1.0), square_of(table), combination({{1.0, angle}, {1.0, table}})}) {
    EXPECT_EQ(f.end(), 3.0);
  }
  EXPECT_TRUE(cosine_of(0.0, 2.0).is_constant());
  EXPECT_EQ(square_of(-3.0).at(7.0).value, 9.0);
  EXPECT_TRUE(combination({{2.0, 1.0}}, 1.0).is_constant());
}

TEST(Corner, IsFoundWhereverItLies) {
  for (const double at : {1.0, 0.95, 1.02, 0.11, 1.93}) {
    const auto times = steps(21, 0.1);
    const auto row = corner_of(times, sampled(times, [&](double t) { return std::abs(t - at); }));
    ASSERT_TRUE(row.has_value()) << at;
    EXPECT_NEAR(times[*row], at, 0.1);
  }
  const auto times = steps(41, 0.1);
  const auto square = [](double t) { return std::floor(t) - 2 * std::floor(t / 2); };
  EXPECT_TRUE(corner_of(times, sampled(times, square)));  // jumps
  const auto triangle = [](double t) { return std::abs(std::remainder(t, 2.0)); };
  EXPECT_TRUE(corner_of(times, sampled(times, triangle)));
  const auto ramp = [](double t) { return t < 2 ? 0.0 : t - 2; };
  EXPECT_TRUE(corner_of(times, sampled(times, ramp)));
  EXPECT_TRUE(
      corner_of({0, 0.1, 0.5, 1.0, 1.1, 1.7, 2.0, 2.5}, {1, 0.9, 0.5, 0, 0.1, 0.7, 1, 1.5}));
  EXPECT_TRUE(corner_of({0, 0.5, 1, 1.5, 2}, {1, 0.5, 0, 0.5, 1}));
}

TEST(Corner, CoarseTablesAreFound) {
  EXPECT_TRUE(corner_of({0, 1, 1.001, 2}, {0, 0, 1, 1}));
  EXPECT_TRUE(corner_of({0, 1, 2, 3}, {0, 0, 1, 1}));
  EXPECT_TRUE(corner_of({0, 1, 2, 3}, {0, 0, 0, 1}));
  const auto times = steps(41, 0.1);
  for (const std::size_t at : {0u, 1u, 2u, 3u, 20u, 38u, 39u, 40u}) {
    std::vector<double> spike(41, 0.0);
    spike[at] = 1.0;
    EXPECT_TRUE(corner_of(times, spike)) << at;
  }
  for (const int period : {2, 3, 4}) {  // rows of a sine
    const auto wave = [&](double t) { return std::sin(20 * std::numbers::pi * t / period + 0.7); };
    EXPECT_TRUE(corner_of(times, sampled(times, wave))) << period;
  }
}

TEST(Corner, SmoothStepsAndShortTablesHaveNone) {
  for (const int rise : {3, 4, 8, 20}) {
    for (const double shift : {0.0, 0.3, 0.5}) {
      const auto step = [&](double t) {
        const double x = std::clamp((t - 10 - shift) / rise, 0.0, 1.0);
        return 0.5 - 0.5 * std::cos(std::numbers::pi * x);
      };
      EXPECT_FALSE(corner_of(steps(41, 1.0), sampled(steps(41, 1.0), step))) << rise << shift;
    }
  }
  for (int phase = 0; phase < 60; ++phase) {
    const auto wave = [&](double t) {
      return std::sin(2 * std::numbers::pi * (t / 6 + phase / 60.0));
    };
    for (const int rows : {4, 5, 6, 7, 20}) {
      EXPECT_FALSE(corner_of(steps(rows, 1.0), sampled(steps(rows, 1.0), wave)))
          << rows << ' ' << phase;
    }
  }
  EXPECT_FALSE(corner_of({0, 0.001, 1, 2}, {0, 0.001, 1, 2}));
  const double third = 1.0 / 3, next = std::nextafter(third, 1.0);  // rounding is no zigzag
  EXPECT_FALSE(corner_of({0, 1, 2, 3, 4, 5}, {third, next, third, next, third, next}));
}

TEST(Corner, SmoothTablesHaveNone) {
  for (const int rows_a_period : {6, 7, 8, 12, 50}) {
    for (const double phase : {0.0, 0.1, 0.5, 1.0}) {
      const auto times = steps(4 * rows_a_period + 1, 1.0 / rows_a_period);
      const auto wave = [&](double t) { return std::sin(2 * std::numbers::pi * t + phase); };
      EXPECT_FALSE(corner_of(times, sampled(times, wave))) << rows_a_period << ' ' << phase;
    }
  }
  const auto times = steps(60, 0.05, -1.0);
  EXPECT_FALSE(corner_of(times, sampled(times, [](double t) { return 3 - 2 * t; })));
  EXPECT_FALSE(corner_of(times, sampled(times, [](double t) { return t * t; })));
  EXPECT_FALSE(corner_of(times, sampled(times, [](double t) { return t > 0 ? t * t : 0.0; })));
  EXPECT_FALSE(corner_of(times, sampled(times, [](double t) { return std::tanh(5 * t); })));
  EXPECT_FALSE(corner_of(times, sampled(times, [](double t) { return std::exp(-20 * t * t); })));
  // Values rounded to three digits: corners of the rounding do not count.
  const auto rounded = [](double t) { return std::round(1000 * t / 3) / 1000; };
  EXPECT_FALSE(corner_of(steps(40, 1.0), sampled(steps(40, 1.0), rounded)));
  EXPECT_FALSE(corner_of({0, 1, 2, 3}, {0, 1, 4, 9}));
  EXPECT_FALSE(corner_of({0, 1, 2, 3}, {0, 0, 0, 0}));
}

}  // namespace
}  // namespace mbs
