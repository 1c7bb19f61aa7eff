// What two runs of one method may differ by.
#include "check/lock_step.hpp"

#include <gtest/gtest.h>

namespace mbs {
namespace {

/// A step of two passes that ends `size` (m) from the origin, with the tangent's `condition`.
Probe probe_of(double size, double condition) {
  Probe probe;
  probe.after.q = {size, 0.0};
  probe.after.lambda = {1.0};
  probe.outcome.passes = 2;
  probe.condition = condition;
  return probe;
}

TEST(FreeRunningTolerance, IsTightWhereRoundingIsFarBelowTheMethod) {
  const FreeRunningTolerance allowed = free_running_tolerance(probe_of(40.0, 1e4), {}, 40.0);
  EXPECT_EQ(allowed.q, 1e-7);
  EXPECT_EQ(allowed.passes, 0.005);
  EXPECT_TRUE(allowed.multipliers);
}

TEST(FreeRunningTolerance, FollowsRoundingWhereThatDecides) {
  const Probe probe = probe_of(1e4, 7e6);  // about N = 9999
  const FreeRunningTolerance allowed = free_running_tolerance(probe, {}, 1e4);
  EXPECT_EQ(allowed.q, 100 * lock_step_tolerance(probe, {}).q);
  EXPECT_NEAR(allowed.q, 2.35e-6, 0.02e-6);  // 100 * 4 u * 2 passes * sqrt(7e6) * 1e4
  EXPECT_EQ(allowed.passes, 0.2);
  EXPECT_FALSE(allowed.multipliers);
}

TEST(FreeRunningTolerance, OfSinglePrecisionOnlyFollowsTheMotion) {
  StepSettings settings;
  settings.precision = Precision::single_precision;
  EXPECT_EQ(free_running_tolerance(probe_of(40.0, 1e4), settings, 40.0).q, 1e-2);
  EXPECT_EQ(free_running_tolerance(probe_of(1e-6, 1e4), settings, 1e-6).q, 1e-8);
}

TEST(FreeRunningTolerance, IsAShareOfASmallScene) {
  EXPECT_DOUBLE_EQ(free_running_tolerance(probe_of(1e-6, 1e4), {}, 1e-6).q, 1e-13);
  EXPECT_EQ(free_running_tolerance(probe_of(1.0, 1e16), {}, 1.0).q, 1e-6);  // not 9e-6
  EXPECT_DOUBLE_EQ(free_running_tolerance(probe_of(1e-6, 1e16), {}, 1e-6).q, 1e-12);
}

}  // namespace
}  // namespace mbs
