// A run's typed outcome: what is ok, what is not, and that NaN never is.
#include "run/run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "check/reference_run.hpp"
#include "controls/controls.hpp"
#include "run/settings.hpp"
#include "run/stretch.hpp"
#include "scene_file/load_scene.hpp"
#include "support/run_settings.hpp"
#include "support/sample_models.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

TEST(Run, HoldsALongMechanismByTheAutomaticPenaltyFactor) {
  // With beta s_min below 1 rounding grows by a fifth and more in each step.
  const Scene scene = load_scene("scissors:60");
  const RunSummary summary = run(scene, test::reference(), test::automatic_settings(scene, 0.25));
  EXPECT_EQ(summary.status, RunStatus::plausible) << summary.reason;
}

TEST(Run, ReportsASoundRun) {
  const Scene scene = load_scene("four-bar:2");
  long calls = 0;
  double last = -1.0;
  const RunSummary summary = run(scene, test::reference(), test::automatic_settings(scene, 2.0),
                                 [&](long step, double t, const State& state) {
                                   EXPECT_EQ(step, calls++);
                                   EXPECT_NEAR(t, 1.25e-3 * static_cast<double>(step), 1e-15);
                                   EXPECT_EQ(state.q.size(), 6U);
                                   last = t;
                                 });
  EXPECT_EQ(summary.status, RunStatus::ok) << summary.reason;
  EXPECT_EQ(summary.reason, "");
  EXPECT_FALSE(summary.failed_at);
  EXPECT_EQ(summary.steps, 1600);
  EXPECT_EQ(calls, 1601);
  EXPECT_NEAR(last, 2.0, 1e-12);
  EXPECT_GT(summary.passes, 1600);
  EXPECT_GT(summary.setup_us, 0.0);
  EXPECT_GT(summary.step_us.median, 0.0);
  EXPECT_LE(summary.step_us.median, summary.step_us.p99);
  EXPECT_LE(summary.step_us.p99, summary.step_us.max);
  ASSERT_TRUE(summary.position_error_max);
  EXPECT_GT(*summary.position_error_max, 1e-8);
  EXPECT_LT(*summary.position_error_max, 1e-3);
  ASSERT_TRUE(summary.energy_drift_max);
  EXPECT_LT(*summary.energy_drift_max, 1e-4);
  EXPECT_LT(summary.constraint_violation_max, 1e-6);
}

TEST(Run, AnObserverThatCannotWriteIsNoDivergence) {
  const Scene scene = load_scene("four-bar:1");
  const auto observer = [](long step, double, const State&) {
    if (step == 3) throw UsageError("cannot write");
  };
  EXPECT_THROW(run(scene, test::reference(), test::automatic_settings(scene, 0.5), observer),
               UsageError);
}

TEST(Run, HasNoPositionErrorWithoutAnExactSolution) {
  const Scene scene = test::spatial_pendulum();
  const RunSummary summary = run(scene, test::reference(), test::automatic_settings(scene, 0.5));
  EXPECT_EQ(summary.status, RunStatus::plausible) << summary.reason;
  EXPECT_FALSE(summary.position_error_max);
  EXPECT_LT(summary.energy_drift_max.value(), 1e-3);
}

TEST(Run, WorksWithoutConstraints) {
  const Scene scene = test::free_fall();
  const RunSummary summary = run(scene, test::reference(), test::automatic_settings(scene, 0.5));
  EXPECT_EQ(summary.status, RunStatus::plausible) << summary.reason;
  EXPECT_EQ(summary.constraint_violation_max, 0.0);
  EXPECT_LT(summary.energy_drift_max.value(), 1e-12);
}

TEST(Run, TellsThatTooSoftOrTooStiffAPenaltyDiverges) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  const struct {
    const char* scene;
    double penalty;
  } cases[] = {{"four-bar:5", 1e22}, {"four-bar:40", 1e8}, {"four-bar:3", 1e-3}};
  std::vector<NamedVariant> variants = all_variants();
  if (MBS_SANITIZE) variants.resize(1);  // many steps; what judges them is the same for all
  for (const NamedVariant& variant : variants) {
    for (const auto& [name, penalty] : cases) {
      const Scene scene = load_scene(name);
      RunSettings settings = test::automatic_settings(scene, 20.0);
      settings.step.penalty = penalty;
      settings.step.tolerance = 1e-9;
      const RunSummary summary = run(scene, *variant.variant, settings);
      EXPECT_EQ(summary.status, RunStatus::diverged) << variant.name << " on " << name;
      EXPECT_NE(summary.reason, "");
      ASSERT_TRUE(summary.failed_at);
      EXPECT_GT(*summary.failed_at, 0.0);
      const double judged = 1.25e-3 * static_cast<double>(summary.steps);
      EXPECT_LE(*summary.failed_at, judged + 1e-9);
      EXPECT_GT(*summary.failed_at,  // eight states are judged together
                judged - 9 * 1.25e-3 * static_cast<double>(judge_interval(scene, settings)));
    }
  }
}

TEST(Run, SaysByHowMuchItIsDegraded) {
  const Scene scene = load_scene("four-bar:1");
  RunSettings settings = test::automatic_settings(scene, 10.0);
  settings.step = chosen(scene.model, {.step = 1e-2});
  const RunSummary summary = run(scene, test::reference(), settings);
  EXPECT_EQ(summary.status, RunStatus::degraded);
  EXPECT_TRUE(summary.reason.starts_with("position error ")) << summary.reason;
  EXPECT_TRUE(summary.reason.ends_with(" (ok to 0.01): a shorter step may help")) << summary.reason;
  EXPECT_GT(*summary.position_error_max, AccurateBounds{}.position_error);
}

TEST(Run, SaysByWhenItIsDegraded) {
  const Scene scene = load_scene("four-bar:1");
  RunSettings settings = test::automatic_settings(scene, 10.0);
  settings.step = chosen(scene.model, {.step = 1e-2});
  const auto status = [&](double duration) {
    settings.duration = duration;
    return run(scene, test::reference(), settings).status;
  };
  const std::optional<double> since = run(scene, test::reference(), settings).failed_at;
  ASSERT_TRUE(since);
  EXPECT_EQ(status(*since), RunStatus::degraded) << *since;
  EXPECT_EQ(status(*since - 10.0 / 16), RunStatus::ok) << *since;
}

TEST(Run, TellsThatStepsDidNotConverge) {
  const Scene scene = load_scene("four-bar:2");
  RunSettings settings = test::automatic_settings(scene, 0.5);
  settings.step.max_passes = 1;
  settings.step.tolerance = 1e-15;
  const RunSummary summary = run(scene, test::reference(), settings);
  EXPECT_EQ(summary.status, RunStatus::not_converged);
  EXPECT_EQ(summary.steps, 400);
  EXPECT_EQ(summary.steps_at_limit, 400);
  EXPECT_EQ(summary.reason,
            "400 of 400 steps ended at the limit of 1 passes (allowed 5 %): a shorter step, a "
            "larger --tolerance or --max-passes may help");
  EXPECT_FALSE(summary.failed_at);
}

TEST(Run, NeverCallsNanOk) {
  const Scene with_exact = load_scene("four-bar:2");
  const Scene without = test::spatial_pendulum();
  for (const Scene* scene : {&with_exact, &without}) {
    for (const auto& [name, step] : {std::pair("nan_after_100", 101L), {"nan_velocity", 1L}}) {
      RunSettings settings = test::automatic_settings(*scene, 0.5);
      settings.judge_every = 1;
      const RunSummary summary = run(*scene, test::control(name), settings);
      EXPECT_EQ(summary.status, RunStatus::diverged) << name;
      EXPECT_EQ(summary.reason, "the state is not finite");
      EXPECT_EQ(summary.steps, step);
      EXPECT_FALSE(std::isfinite(summary.energy_drift_max.value()));
      EXPECT_FALSE(std::isfinite(summary.constraint_violation_max));
      if (summary.position_error_max) {
        EXPECT_FALSE(std::isfinite(*summary.position_error_max));
      }
    }
  }
}

/// f(t) = 1, known until `end`.
class Table final : public TimeFunction::Kind {
 public:
  explicit Table(double end) : end_(end) {}
  [[nodiscard]] TimeFunction::Sample at(double) const override { return {1.0, 0.0, 0.0}; }
  [[nodiscard]] double end() const override { return end_; }

 private:
  double end_;
};

Scene driven_until(double end) {
  ModelData data;
  data.points = {{"A", -1, {0, 0, 0}}, {"B", 0, {1, 0, 0}}};
  data.mass = {{0, 0, 1.0}, {1, 1, 1.0}};
  data.force = data.initial_velocity = {0.0, 0.0};
  data.dot_constraints = {{0, 1, 0, 1, 1.0, "rod"}};
  data.driven_values.push_back({0, TimeFunction(std::make_shared<Table>(end))});
  return {"driven", Model(std::move(data)), {}, {}};
}

TEST(Run, RefusesToGoBeyondADriversEnd) {
  const Scene scene = driven_until(0.5);
  RunSettings settings{.step = chosen(scene.model)};
  settings.duration = 0.5;
  EXPECT_NO_THROW(require_duration(scene, settings));
  settings.duration = 0.51;
  EXPECT_THROW(require_duration(scene, settings), UsageError);
  try {
    run(scene, test::reference(), settings);
    ADD_FAILURE() << "it ran";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("0.51 s, but a driver's table ends at 0.5 s"),
              std::string::npos)
        << error.what();
  }
}

TEST(Stretch, EndsWithTheDrivers) {
  EXPECT_EQ(make_stretch(driven_until(0.5), 1.25e-3, 800).steps, 400);
  EXPECT_EQ(make_stretch(driven_until(0.5), 1.25e-3, 300).steps, 300);
  EXPECT_EQ(make_stretch(driven_until(0.3), 0.1, 300).steps, 3);  // 0.3 / 0.1 < 3
  EXPECT_THROW(make_stretch(driven_until(0.5), 0.6, 300), UsageError);
}

TEST(ReferenceRun, ProbesEachStepOfAShortStretch) {
  const Scene scene = driven_until(0.3);
  const ReferenceRun reference = run_reference(scene, chosen(scene.model, {.step = 0.1}));
  ASSERT_EQ(reference.probes.size(), 3U);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(reference.probes[static_cast<std::size_t>(i)].t, 0.1 * i, 1e-15);
}

TEST(Run, TellsThatAFactorizationFailed) {
  const Scene scene = load_scene("four-bar:2");
  const RunSummary summary =
      run(scene, test::control("factorization_failed"), test::automatic_settings(scene, 0.5));
  EXPECT_EQ(summary.status, RunStatus::diverged);
  EXPECT_EQ(summary.reason, "the tangent matrix could not be factorized");
  EXPECT_EQ(summary.steps, 1);
}

TEST(Run, TellsWhatTheMultistepMethodCannotPass) {
  const Scene scene = load_scene("four-bar:2");
  RunSettings settings = test::automatic_settings(scene, 0.5);
  settings.step.scheme = Scheme::multistep6;
  Variant variant = test::control("factorization_failed");
  variant.serves.multistep = true;
  const RunSummary summary = run(scene, variant, settings);
  EXPECT_EQ(summary.status, RunStatus::diverged);
  EXPECT_EQ(summary.reason,
            "the tangent matrix could not be factorized (multistep6 cannot pass singular "
            "positions: if there is one, try rattle)");
}

TEST(Run, TellsThatASceneIsUnsupported) {
  const Scene scene = load_scene("four-bar:2");
  const RunSummary summary =
      run(scene, test::control("unsupported"), test::automatic_settings(scene, 0.5));
  EXPECT_EQ(summary.status, RunStatus::unsupported);
  EXPECT_NE(summary.reason, "");
  EXPECT_EQ(summary.steps, 0);
  EXPECT_FALSE(summary.failed_at);
}

TEST(Run, NamesEachStatus) {
  EXPECT_EQ(to_string(RunStatus::ok), "ok");
  EXPECT_EQ(to_string(RunStatus::plausible), "plausible");
  EXPECT_EQ(to_string(RunStatus::not_converged), "not-converged");
  EXPECT_EQ(to_string(RunStatus::degraded), "degraded");
  EXPECT_EQ(to_string(RunStatus::diverged), "diverged");
  EXPECT_EQ(to_string(RunStatus::wrong_branch), "wrong-branch");
  EXPECT_EQ(to_string(RunStatus::unsupported), "unsupported");
}

TEST(CountSteps, RoundsToWholeSteps) {
  RunSettings settings{.step = {.penalty = 1e8, .tolerance = 1e-9}};
  EXPECT_EQ(count_steps(settings), 16'000);
  settings.duration = 1.9e-3;
  EXPECT_EQ(count_steps(settings), 2);
  settings.duration = 3 * 0.1;  // a rounding above 0.3
  settings.step.step = 0.3;
  EXPECT_EQ(count_steps(settings), 1);
  settings.duration = 0.3;
  settings.step.step = 3 * 0.1;
  EXPECT_EQ(count_steps(settings), 1);
}

TEST(CountSteps, RefusesWhatIsOutOfRange) {
  const auto expect_refusal = [](auto&& spoil, const std::string& word) {
    RunSettings settings{.step = {.penalty = 1e8, .tolerance = 1e-9}};
    spoil(settings);
    try {
      count_steps(settings);
      ADD_FAILURE() << word;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    expect_refusal([bad](RunSettings& s) { s.step.step = bad; }, "--step");
    expect_refusal([bad](RunSettings& s) { s.duration = bad; }, "--duration");
    expect_refusal([bad](RunSettings& s) { s.deadline_us = bad; }, "--deadline-us");
    expect_refusal([bad](RunSettings& s) { s.step.penalty = bad; }, "--penalty");
    expect_refusal([bad](RunSettings& s) { s.step.tolerance = bad; }, "--tolerance");
  }
  for (const int bad : {0, -1, 1001}) {
    expect_refusal([bad](RunSettings& s) { s.repeats = bad; }, "--repeats");
    expect_refusal([bad](RunSettings& s) { s.step.max_passes = bad; }, "--max-passes");
  }
  expect_refusal([](RunSettings& s) { s.duration = 0.9 * s.step.step; },
                 "shorter than one step: it must be at least --step, 0.00125 s");
  expect_refusal([](RunSettings& s) { s.duration = 1e6; }, "at most 1e+08");
  expect_refusal([](RunSettings& s) { s.step.step = 1e-300; }, "at most 1e+08");
}

}  // namespace
}  // namespace mbs
