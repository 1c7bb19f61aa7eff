// The closed form, Eq. (10), against the differential equation that it solves, Eq. (9).
#include <gtest/gtest.h>

#include <boost/math/special_functions/ellint_1.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "exact/four_bar_exact.hpp"

namespace mbs {
namespace {

using Real = long double;

Real stiffness(int loops) {  // k of Eq. (9)
  return 3 * 9.81L * (3 * loops + 1) / (2 * (4.0L * loops + 1));
}

struct Pendulum {
  Real phi = 0, rate = 1;
};

/// phi'' = k sin phi by the classical Runge-Kutta method of order four, in steps of 50 us.
Pendulum integrate(int loops, Real duration) {
  const Real k = stiffness(loops);
  const long steps = std::lround(20'000 * duration) + 1;
  const Real h = duration / steps;
  Pendulum x;
  for (long i = 0; i < steps; ++i) {
    const Real v1 = x.rate, a1 = k * std::sin(x.phi);
    const Real v2 = x.rate + h / 2 * a1, a2 = k * std::sin(x.phi + h / 2 * v1);
    const Real v3 = x.rate + h / 2 * a2, a3 = k * std::sin(x.phi + h / 2 * v2);
    const Real v4 = x.rate + h * a3, a4 = k * std::sin(x.phi + h * v3);
    x.phi += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    x.rate += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return x;
}

Real period(int loops) {  // of Eq. (10)
  const Real w = std::sqrt(1 + 4 * stiffness(loops));
  return 4 * boost::math::ellint_1(std::sqrt(4 * stiffness(loops)) / w) / w;
}

class FourBarExactOf : public ::testing::TestWithParam<int> {};

TEST_P(FourBarExactOf, SolvesTheEquationOfMotion) {
  const int loops = GetParam();
  const FourBarExact exact(loops);
  for (const double t : {0.0, 0.1, 0.625, 1.0, 2.5, 5.0}) {
    const Pendulum x = integrate(loops, t);
    const FourBarExact::Angle angle = exact.angle(t);
    EXPECT_NEAR(static_cast<double>(angle.sine - std::sin(x.phi)), 0.0, 1e-12) << t;
    EXPECT_NEAR(static_cast<double>(angle.cosine - std::cos(x.phi)), 0.0, 1e-12) << t;
    EXPECT_NEAR(static_cast<double>(angle.rate - x.rate), 0.0, 1e-12) << t;
    EXPECT_NEAR(static_cast<double>(angle.acceleration - stiffness(loops) * std::sin(x.phi)), 0.0,
                1e-11)
        << t;
  }
}

TEST_P(FourBarExactOf, KeepsTheEnergy) {
  const FourBarExact exact(GetParam());
  const Real k = stiffness(GetParam());
  for (const double t : {0.0, 1e-9, 0.3, 0.8, 7.0, 123.456, 1000.0, 1e6}) {
    const auto x = exact.angle(t);
    EXPECT_NEAR(static_cast<double>(x.rate * x.rate / 2 + k * x.cosine - (0.5L + k)), 0.0, 1e-15)
        << t;
    EXPECT_NEAR(static_cast<double>(x.sine * x.sine + x.cosine * x.cosine), 1.0, 1e-15) << t;
  }
}

TEST_P(FourBarExactOf, IsPeriodicForAThousandSeconds) {
  const FourBarExact exact(GetParam());
  const Real length = period(GetParam());
  for (const int turns : {1, 10, static_cast<int>(1000 / length)}) {
    for (const double t : {0.0, 0.4, 1.1}) {
      const auto late = static_cast<double>(t + turns * length);
      const Real shift = Real{late} - turns * length;  // what rounding made of t
      const auto x = exact.angle(t), y = exact.angle(late);
      EXPECT_NEAR(static_cast<double>(y.sine - x.sine - x.cosine * x.rate * (shift - t)), 0.0,
                  1e-14);
      EXPECT_NEAR(static_cast<double>(y.cosine - x.cosine + x.sine * x.rate * (shift - t)), 0.0,
                  1e-14);
      EXPECT_NEAR(static_cast<double>(y.rate - x.rate - x.acceleration * (shift - t)), 0.0, 1e-13);
    }
  }
  EXPECT_NEAR(static_cast<double>(exact.angle(static_cast<double>(length / 2)).cosine), -1.0,
              1e-14);
}

TEST_P(FourBarExactOf, VelocityAndAccelerationAreDerivatives) {
  const int loops = GetParam();
  const FourBarExact exact(loops);
  const auto n = static_cast<std::size_t>(2 * loops + 2);
  std::vector<double> q(n), v(n), a(n), before(n), after(n), v_before(n), v_after(n), unused(n);
  constexpr double h = 1e-4;
  for (const double t : {0.5, 0.7, 0.9, 3.0}) {
    exact.state(t, q, v, a);
    exact.state(t - h, before, v_before, unused);
    exact.state(t + h, after, v_after, unused);
    for (std::size_t i = 0; i < n; ++i) {
      // Central differences: h^2/6 of the third derivatives, which stay below 1e4; rounding below.
      EXPECT_NEAR(v[i], (after[i] - before[i]) / (2 * h), 2e-5);
      EXPECT_NEAR(a[i], (v_after[i] - v_before[i]) / (2 * h), 2e-5);
    }
  }
}

TEST_P(FourBarExactOf, FirstSingularTimeIsTheFirst) {
  const FourBarExact exact(GetParam());
  const double singular = exact.first_singular_time();
  EXPECT_GT(singular, 0.7);
  EXPECT_LT(singular, 0.8);
  EXPECT_NEAR(static_cast<double>(exact.angle(singular).cosine), 0.0, 1e-14);
  for (int i = 0; i < 100; ++i) EXPECT_GT(exact.angle(singular * i / 100).cosine, 0) << i;
}

INSTANTIATE_TEST_SUITE_P(Sizes, FourBarExactOf, ::testing::Values(1, 2, 10, 40, 1999),
                         ::testing::PrintToStringParamName());

TEST(FourBarExact, StartsAsStated) {
  const FourBarExact exact(3);
  std::vector<double> q(8), v(8), a(8);
  exact.state(0.0, q, v, a);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(q[2 * i], static_cast<double>(i), 1e-18);
    EXPECT_NEAR(q[2 * i + 1], 1.0, 1e-15);
    EXPECT_NEAR(v[2 * i], 1.0, 1e-15);
    EXPECT_NEAR(v[2 * i + 1], 0.0, 1e-18);
    EXPECT_NEAR(a[2 * i], 0.0, 1e-16);
    EXPECT_NEAR(a[2 * i + 1], -1.0, 1e-15);
  }
}

TEST(FourBarExact, PositionErrorIsTheLargestDistance) {
  const FourBarExact exact(2);
  std::vector<double> q(6), v(6), a(6);
  exact.state(1.3, q, v, a);
  EXPECT_LT(exact.position_error(1.3, q), 1e-15);
  q[2] += 3e-3;
  q[3] -= 4e-3;
  q[5] += 1e-3;
  EXPECT_NEAR(exact.position_error(1.3, q), 5e-3, 1e-15);
  q[5] += 6e-3;
  EXPECT_NEAR(exact.position_error(1.3, q), 7e-3, 1e-15);
}

TEST(FourBarExact, PositionErrorOfANaNIsNaN) {
  const FourBarExact exact(2);
  std::vector<double> q(6), v(6), a(6);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL}) {
    for (std::size_t i = 0; i < 6; ++i) {
      exact.state(1.3, q, v, a);
      q[i] = bad;
      EXPECT_TRUE(std::isnan(exact.position_error(1.3, q))) << i;
    }
  }
}

TEST(FourBarExact, RefusesSizesThatDoNotExist) {
  EXPECT_THROW(FourBarExact(0), std::invalid_argument);
  EXPECT_THROW(FourBarExact(-1), std::invalid_argument);
}

}  // namespace
}  // namespace mbs
