// Curves through tables, against Boost's and against their own difference quotients.
#include "model_math/monotone_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "support/boost_pchip.hpp"

namespace mbs {
namespace {

// Rises, is level, has a peak; rows of very unequal distance.
const std::vector<double> kX{-1.0, -0.4, 0.0, 0.1, 1.5, 2.0}, kY{-5.0, -1.0, 0.0, 0.0, 3.0, 2.0};

TEST(MonotoneCurve, IsBoostsWithinTheTable) {
  const auto boosts = test::boost_pchip(kX, kY);
  const Curve curve = monotone_curve(kX, kY);
  for (double x = -0.999; x < 2.0; x += 0.0137) {
    EXPECT_NEAR(curve.at(x).value, boosts(x), 1e-14) << x;
    EXPECT_NEAR(curve.at(x).slope, boosts.prime(x), 1e-13) << x;
  }
}

TEST(MonotoneCurve, GoesOnStraightBeyondTheTable) {
  const Curve curve = monotone_curve(kX, kY);
  for (const double end : {kX.front(), kX.back()}) {
    const Curve::Sample at = curve.at(end);
    const double beyond = end + (end > 0.0 ? 3.0 : -3.0);
    EXPECT_NEAR(curve.at(beyond).value, at.value + at.slope * (beyond - end), 1e-14);
    EXPECT_EQ(curve.at(beyond).slope, at.slope);
  }
}

TEST(MonotoneCurve, HasNeitherJumpsNorKinks) {
  const Curve curve = monotone_curve(kX, kY);
  for (const double x : kX) {
    const Curve::Sample before = curve.at(std::nextafter(x, -9.0)), after = curve.at(x);
    EXPECT_NEAR(before.value, after.value, 1e-14) << x;
    EXPECT_NEAR(before.slope, after.slope, 1e-13) << x;
  }
}

TEST(MonotoneCurve, TwoRowsAreALine) {
  const Curve curve = monotone_curve({0.3, 0.7}, {-1.3, 2.9});
  for (const double x : {-5.0, 0.3, 0.41, 0.7, 8.0}) {
    EXPECT_NEAR(curve.at(x).value, -1.3 + (4.2 / 0.4) * (x - 0.3), 1e-13);
    EXPECT_NEAR(curve.at(x).slope, 4.2 / 0.4, 1e-14);
  }
}

TEST(MonotoneCurve, IntegralIsThePotential) {
  using boost::math::quadrature::gauss_kronrod;
  const Curve curve = monotone_curve(kX, kY);
  EXPECT_EQ(integral(curve, 0.0), 0.0);  // the first of the rows with the least value
  for (const double x : {-3.0, -1.0, -0.7, 0.05, 1.0, 1.5, 1.8, 4.0}) {
    double sum = 0.0, from = std::min(x, 0.0);
    const double to = std::max(x, 0.0);
    for (const double next : {-1.0, -0.4, 0.0, 0.1, 1.5, 2.0, to}) {  // smooth between breaks
      if (next <= from || next > to) continue;
      sum += gauss_kronrod<double, 15>::integrate([&](double z) { return curve.at(z).value; }, from,
                                                  next, 0);
      from = next;
    }
    EXPECT_NEAR(integral(curve, x), x < 0.0 ? -sum : sum, 1e-13) << x;
  }
}

}  // namespace
}  // namespace mbs
