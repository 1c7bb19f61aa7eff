// The error estimate by half the step against the exact error, and what it does to the outcome.
#include <gtest/gtest.h>

#include <cmath>

#include "controls/controls.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/sample_models.hpp"

namespace mbs {
namespace {

RunSettings with_half_step(const Scene& scene, Scheme scheme, double step, double duration) {
  const auto resolved = [&](double h) {
    StepSettings settings;
    settings.scheme = scheme;
    settings.step = h;
    settings.penalty = automatic_penalty(scene.model, settings);
    settings.tolerance = 1e-14;
    return settings;
  };
  RunSettings settings;
  settings.step = resolved(step);
  settings.half_step = resolved(step / 2);
  settings.duration = duration;
  settings.judge_every = 1;
  return settings;
}

TEST(HalfStep, EstimatesTheExactError) {
  const Scene scene = load_scene("four-bar:2");
  const struct {
    Scheme scheme;
    double step, duration;
  } cases[] = {{Scheme::penalty, 2.5e-3, 2.0}, {Scheme::saddle_point, 2.5e-3, 2.0},
               {Scheme::rattle, 2e-3, 0.6},    {Scheme::rattle4, 1e-2, 0.6},
               {Scheme::rattle6, 2.5e-2, 0.6}, {Scheme::multistep6, 1e-2, 0.6}};
  for (const auto& [scheme, step, duration] : cases) {
    const RunSummary summary =
        run(scene, test::reference(), with_half_step(scene, scheme, step, duration));
    ASSERT_TRUE(summary.position_error_estimate && summary.position_error_max);
    EXPECT_NEAR(*summary.position_error_estimate / *summary.position_error_max, 1.0, 0.1)
        << static_cast<int>(scheme);
    EXPECT_EQ(summary.status, RunStatus::ok) << summary.reason;
  }
}

TEST(HalfStep, DegradesARunWithoutAnExactSolution) {
  const Scene scene = load_scene(MBS_ROOT "/harness/scenes/double_pendulum.json");
  RunSettings settings = with_half_step(scene, Scheme::penalty, 2e-2, 5.0);
  const RunSummary estimated = run(scene, test::reference(), settings);
  EXPECT_EQ(estimated.status, RunStatus::degraded);
  EXPECT_NE(estimated.reason.find("estimated position error"), std::string::npos)
      << estimated.reason;
  EXPECT_NE(estimated.reason.find("of a length at most, at C (ok"), std::string::npos)
      << estimated.reason;
  EXPECT_FALSE(estimated.position_error_max);
  settings.half_step.reset();
  EXPECT_FALSE(run(scene, test::reference(), settings).position_error_estimate);
}

TEST(LocalErrors, DegradeARunThatEnergyAndConstraintsCallSound) {
  const Scene scene = load_scene(MBS_ROOT "/harness/scenes/problems/slider_crank.json");
  RunSettings settings;
  settings.duration = 5.0;
  const auto with_step = [&](double step) {
    settings.step = chosen(scene.model, {.step = step});
    return run(scene, test::reference(), settings);
  };
  const RunSummary coarse = with_step(1.25e-3);
  EXPECT_EQ(coarse.status, RunStatus::degraded);
  EXPECT_NE(coarse.reason.find("local errors add up to"), std::string::npos) << coarse.reason;
  EXPECT_EQ(with_step(1.5625e-4).status, RunStatus::plausible);
}

TEST(HalfStep, IsInfiniteWhereTheHalfStepIsLost) {
  const Scene scene = load_scene("four-bar:5");
  RunSettings settings = with_half_step(scene, Scheme::penalty, 1e-3, 2.0);
  settings.half_step->penalty = 1e30;
  const RunSummary summary = run(scene, test::reference(), settings);
  EXPECT_EQ(summary.status, RunStatus::degraded) << summary.reason;
  EXPECT_FALSE(*summary.position_error_estimate < 1e-2);
}

TEST(Deadline, CountsTheStepsBeyondIt) {
  const Scene scene = load_scene("four-bar:1");
  RunSettings settings;
  settings.step = chosen(scene.model);
  settings.duration = 0.25;
  EXPECT_FALSE(run(scene, test::reference(), settings).step_us.deadline_misses);
  settings.deadline_us = 1e-6;
  EXPECT_EQ(run(scene, test::reference(), settings).step_us.deadline_misses, 200);
  settings.deadline_us = 1e12;
  const RunSummary summary = run(scene, test::reference(), settings);
  EXPECT_EQ(summary.step_us.deadline_misses, 0);
  EXPECT_LE(summary.step_us.p99, summary.step_us.p999);
  EXPECT_GT(summary.step_us.mean, 0.0);
}

TEST(Repeats, TellEachStepsLeastTime) {
  const Scene scene = load_scene("four-bar:1");
  RunSettings settings;
  settings.step = chosen(scene.model);
  settings.duration = 0.25;
  settings.deadline_us = 1e-6;
  EXPECT_FALSE(run(scene, test::reference(), settings).least_us);
  settings.repeats = 3;
  const RunSummary summary = run(scene, test::reference(), settings);
  ASSERT_TRUE(summary.least_us);
  EXPECT_EQ(summary.steps, 200);
  EXPECT_EQ(summary.least_us->deadline_misses, 200);
  EXPECT_GT(summary.least_us->median, 0.0);
  EXPECT_LT(summary.least_us->mean, summary.step_us.mean);
  EXPECT_LE(summary.least_us->max, summary.step_us.max);
}

}  // namespace
}  // namespace mbs
