// When states are looked at: how often, together or alone, and what a look that was wrong leaves
// behind.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "controls/controls.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/run_settings.hpp"
#include "support/sample_models.hpp"
#include "support/scripted_simulation.hpp"

namespace mbs {
namespace {

template <class Kind>
Variant variant_of() {
  Variant variant = test::reference();
  variant.create = [](const Model& model,
                      const StepSettings& settings) -> std::unique_ptr<Simulation> {
    return std::make_unique<Kind>(model, settings);
  };
  return variant;
}

/// A point at rest; copying its state out takes a tenth of a millisecond.
class SlowToCopy final : public Simulation {
 public:
  static constexpr std::chrono::microseconds kCopy{100};
  static inline long copies = 0;
  using Simulation::Simulation;

 protected:
  void do_set_state(const State& state) override { state_ = state; }
  StepOutcome do_step() override { return {StepStatus::converged, 1}; }
  void do_get_state(State& state) const override {
    test::wait(kCopy);
    ++copies;
    state = state_;
  }

 private:
  State state_;
};

TEST(JudgedRun, CountsTheCopiesThatJudgingNeedsWhoeverElseLooks) {
  ModelData data;
  data.points = {{"A", -1, {0, 0, 0}}, {"B", 0, {1, 0, 0}}};
  data.mass = {{0, 0, 1.0}, {1, 1, 1.0}};
  data.force = data.initial_velocity = {0.0, 0.0};
  const Scene scene{"at rest", Model(std::move(data)), {}, {}};
  const Variant variant = variant_of<SlowToCopy>();
  RunSettings settings = test::automatic_settings(scene, 0.5);
  settings.step.tolerance = 1e-15;
  settings.judge_every = 20;
  const auto judging = [&](const Observer& observer, const Follower& follower) {  // copies
    SlowToCopy::copies = 0;
    const RunSummary summary = run(scene, variant, settings, observer, follower);
    EXPECT_EQ(summary.status, RunStatus::plausible) << summary.reason;
    return summary.judge_us * static_cast<double>(summary.steps) / SlowToCopy::kCopy.count();
  };
  long followed = 0, observed = 0;
  const double alone = judging(
      {}, [&](double t) { EXPECT_NEAR(t, 1.25e-3 * static_cast<double>(++followed), 1e-12); });
  const long needed = SlowToCopy::copies;
  EXPECT_EQ(followed, 400);
  EXPECT_LE(needed, 50);
  const double beside = judging([&](long, double, const State&) { ++observed; }, {});
  EXPECT_EQ(observed, 401);
  EXPECT_GE(SlowToCopy::copies, 400);
  for (const double counted : {alone, beside}) EXPECT_GE(counted, static_cast<double>(needed));
}

TEST(JudgedRun, FindsTheFirstLostStepHoweverSeldomItJudges) {
  const Scene scene = load_scene("four-bar:5");
  RunSettings settings = test::automatic_settings(scene, 6.0);
  settings.step.penalty = 1e4;
  settings.judge_every = 1;
  const RunSummary every = run(scene, test::reference(), settings);
  ASSERT_NE(every.status, RunStatus::ok);
  for (const int judge_every : {0, 7, 100, 100'000}) {  // 0: as the program chooses
    settings.judge_every = judge_every > 0 ? std::optional(judge_every) : std::nullopt;
    const RunSummary seldom = run(scene, test::reference(), settings);
    EXPECT_EQ(seldom.status, every.status) << judge_every;
    EXPECT_EQ(seldom.failed_at, every.failed_at) << judge_every;
    EXPECT_EQ(seldom.reason, every.reason) << judge_every;
  }
}

// A rod of 1/3 kg m^2 that is given a speed, or a torque: whole turns between two judged steps are
// no rest.
TEST(JudgedRun, SeesHalfATurnOfATorsionSpringHoweverFastItTurns) {
  for (const auto& [speed, torque] : {std::pair{"98.17", "0"}, {"0", "300"}}) {
    const Scene scene = scene_of(nlohmann::json::parse(R"({"gravity": [0, 0], "points": [
      {"name": "O", "position": [0, 0], "fixed": true}, {"name": "X", "position": [1, 0], "fixed": true},
      {"name": "B", "position": [1, 0], "velocity": [0, )" +
                                                       std::string(speed) + R"(]}],
    "rods": [{"between": ["O", "B"], "mass": 1}],
    "torques": [{"direction": ["O", "B"], "torque": )" +
                                                       torque + R"(}],
    "torsion_springs": [{"from": ["O", "X"], "to": ["O", "B"], "stiffness": 1e-6, "angle": 0}]})"),
                                 "test");
    RunSettings settings;
    settings.step = chosen(scene.model, {.step = 1e-3});
    settings.duration = 8.0;
    settings.judge_every = 1;
    const RunSummary every = run(scene, test::reference(), settings);
    EXPECT_EQ(every.status, RunStatus::diverged);
    EXPECT_NE(every.reason.find("half a turn"), std::string::npos) << every.reason;
    for (const int judge_every : {0, 100, 100'000}) {  // 0: as the program chooses
      settings.judge_every = judge_every > 0 ? std::optional(judge_every) : std::nullopt;
      const RunSummary seldom = run(scene, test::reference(), settings);
      EXPECT_EQ(seldom.failed_at, every.failed_at) << judge_every;
      EXPECT_EQ(seldom.reason, every.reason) << judge_every;
    }
  }
}

/// A point of 1 kg that hardly moves, with more energy than at the start, but for one step in ten:
/// then it is 5 m lower, and as fast as it has to be.
class Dipping final : public Simulation {
 public:
  static inline double last = 0.0;          // s, the end of the last step
  static inline double throws_after = 1e9;  // s
  using Simulation::Simulation;

 protected:
  void do_set_state(const State& state) override { state_ = state; }
  StepOutcome do_step() override {
    last = time();
    if (last > throws_after) throw std::runtime_error("enough");
    const bool is_low = std::lround(last / 1.25e-3) % 10 == 1;
    state_.q[1] = is_low ? -5.0 : 0.0;
    state_.v[0] = is_low ? std::sqrt(2 * 10 * 5.0) : 0.5;
    return {StepStatus::converged, 1};
  }
  void do_get_state(State& state) const override { state = state_; }

 private:
  State state_;
};

TEST(JudgedRun, GoesOnFromWhereItIsAfterAFalseAlarm) {
  ModelData data;
  data.points = {{"A", -1, {0, 0, 0}}, {"B", 0, {1, 0, 0}}};
  data.mass = {{0, 0, 1.0}, {1, 1, 1.0}};
  data.force = {0.0, -10.0};
  data.initial_velocity = {0.1, 0.0};
  const Scene scene{"dips", Model(std::move(data)), {}, {}};
  const Variant variant = variant_of<Dipping>();
  RunSettings settings = test::automatic_settings(scene, 10.0);
  settings.step.tolerance = 1e-15;  // no step is done again
  const RunSummary summary = run(scene, variant, settings);
  EXPECT_NE(summary.status, RunStatus::diverged) << summary.reason;
  EXPECT_LT(summary.energy_drift_max.value(), 0.01);
  EXPECT_NEAR(Dipping::last, 10.0, 1e-9);
  Dipping::throws_after = 5.0;
  const RunSummary thrown = run(scene, variant, settings);
  Dipping::throws_after = 1e9;
  EXPECT_EQ(thrown.reason, "the implementation threw: enough");
  EXPECT_NEAR(thrown.failed_at.value(), 5.0, 2e-3);
  EXPECT_LT(thrown.energy_drift_max.value(), 0.01);
}

TEST(JudgedRun, JudgesOneStepIn64To128OrThirtyTwoTimes) {
  const Scene scene = test::free_fall(), exact = load_scene("four-bar:1");
  RunSettings settings;
  settings.step = {.step = 1e-3, .penalty = 1e8, .tolerance = 1e-9};
  const auto interval = [&](double duration) {
    settings.duration = duration;
    return judge_interval(scene, settings);
  };
  EXPECT_EQ(interval(20.0), 128);
  EXPECT_EQ(interval(9.6), 75);
  EXPECT_EQ(interval(8.0), 64);
  EXPECT_EQ(interval(1.6), 50);
  EXPECT_EQ(interval(0.01), 1);
  settings.duration = 20.0;
  EXPECT_EQ(judge_interval(exact, settings), 256);
  settings.judge_every = 7;
  EXPECT_EQ(interval(20.0), 7);
}

}  // namespace
}  // namespace mbs
