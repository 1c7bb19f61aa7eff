// Where stretches start and end.
#include "run/stretch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "exact/four_bar_exact.hpp"
#include "run/initial_state.hpp"
#include "scene_file/load_scene.hpp"
#include "support/sample_models.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr double kTimeStep = 1.25e-3;

TEST(Stretch, IsCentredOnTheSingularPosition) {
  for (const int loops : {1, 10, kMostLoopsToCross}) {
    const Scene scene = load_scene("four-bar:" + std::to_string(loops));
    const double singular = FourBarExact(loops).first_singular_time();
    const Stretch stretch = make_stretch(scene, kTimeStep, 800);
    EXPECT_EQ(stretch.steps, 800);
    EXPECT_NEAR(stretch.start + 400 * kTimeStep, singular, 1e-12) << loops;
  }
}

TEST(Stretch, IsClippedAtZero) {
  const Scene scene = load_scene("four-bar:2");
  const Stretch stretch = make_stretch(scene, kTimeStep, 5000);
  EXPECT_EQ(stretch.start, 0.0);
  EXPECT_EQ(stretch.steps, 5000);
}

TEST(Stretch, OfALongChainEndsBeforeTheSingularPosition) {
  const int loops = kMostLoopsToCross + 1;
  const Scene scene = load_scene("four-bar:" + std::to_string(loops));
  const double singular = FourBarExact(loops).first_singular_time();
  const Stretch stretch = make_stretch(scene, kTimeStep, 200);
  EXPECT_NEAR(stretch.start + 200 * kTimeStep, singular - kClearance, 1e-12);
  EXPECT_EQ(stretch.steps, 200);
  const Stretch longest = make_stretch(scene, kTimeStep, 10'000);  // fewer fit
  EXPECT_LT(longest.steps, 400);
  EXPECT_LT(longest.start, kTimeStep);
  EXPECT_NEAR(longest.start + longest.steps * kTimeStep, singular - kClearance, 1e-12);
}

TEST(Stretch, OfASchemeThatDoesNotPassTheSingularPositionEndsBeforeIt) {
  const Scene scene = load_scene("four-bar:2");
  const double singular = FourBarExact(2).first_singular_time();
  const Stretch stretch = make_stretch(scene, kTimeStep, 800, std::nullopt, Scheme::multistep6);
  EXPECT_NEAR(stretch.start + stretch.steps * kTimeStep, singular - kClearance, 1e-12);
}

TEST(Stretch, StartsOnTheExactMotion) {
  const Scene scene = load_scene("four-bar:3");
  const Stretch stretch = make_stretch(scene, kTimeStep, 800);
  const FourBarExact exact(3);
  std::vector<double> q(8), v(8), a(8);
  exact.state(stretch.start, q, v, a);
  EXPECT_EQ(stretch.initial.q, q);
  EXPECT_EQ(stretch.initial.v, v);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(stretch.initial.a[i], a[i], 1e-10);
  EXPECT_EQ(stretch.initial.lambda, consistent_state(scene.model, q, v).lambda);
}

TEST(Stretch, StartsWhereItIsTold) {
  const Scene scene = load_scene("four-bar:3");
  for (const double start : {0.0, 0.1, 17.0}) {
    const Stretch stretch = make_stretch(scene, kTimeStep, 100, start);
    EXPECT_EQ(stretch.start, start);
    EXPECT_LT(FourBarExact(3).position_error(start, stretch.initial.q), 1e-15);
  }
}

TEST(Stretch, OfOtherScenesStartsAtZero) {
  const Scene scene = test::spatial_pendulum();
  const State initial = initial_state(scene.model);
  for (const Stretch& stretch :
       {make_stretch(scene, kTimeStep, 50), make_stretch(scene, kTimeStep, 50, 0.0)}) {
    EXPECT_EQ(stretch.start, 0.0);
    EXPECT_EQ(stretch.steps, 50);
    EXPECT_EQ(stretch.initial.q, initial.q);
    EXPECT_EQ(stretch.initial.a, initial.a);
    EXPECT_EQ(stretch.initial.lambda, initial.lambda);
  }
  EXPECT_THROW(make_stretch(scene, kTimeStep, 50, 1.0), UsageError);
}

TEST(Stretch, RefusesABadStart) {
  const Scene scene = load_scene("four-bar:3");
  for (const double start : {-1e-9, -1.0, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(make_stretch(scene, kTimeStep, 100, start), UsageError) << start;
  }
}

}  // namespace
}  // namespace mbs
