// What neither energy nor constraints show: lags, found by what single steps leave.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "controls/controls.hpp"
#include "run/initial_state.hpp"
#include "run/judged_run.hpp"
#include "run/local_errors.hpp"
#include "run/run.hpp"
#include "run/scene_distance.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/sample_models.hpp"

namespace mbs {
namespace {

Scene shipped(const char* name) {
  return load_scene(std::string(MBS_ROOT "/harness/scenes/") + name);
}

RunSettings settings_for(const Scene& scene, Scheme scheme, double step, double duration) {
  RunSettings settings;
  settings.step.scheme = scheme;
  settings.step.step = step;
  settings.step.penalty = automatic_penalty(scene.model, settings.step);
  settings.step.tolerance = 1e-12;
  settings.duration = duration;
  return settings;
}

/// The same settings at half the step.
StepSettings half_of(const Scene& scene, StepSettings settings) {
  settings.step /= 2;
  settings.penalty = automatic_penalty(scene.model, settings);
  return settings;
}

TEST(LocalErrors, AddUpToTheLagOfLongSteps) {
  // A pendulum at the rate w: what the trapezoidal rule lags is w t (w dt)^2/12.
  const Scene scene = shipped("pendulum.json");
  RunSettings settings = settings_for(scene, Scheme::penalty, 5e-3, 4.0);
  settings.half_step = half_of(scene, settings.step);
  const double error = *run(scene, test::reference(), settings).position_error_estimate;
  settings.half_step.reset();
  const RunSummary summary = run(scene, test::reference(), settings);
  ASSERT_TRUE(summary.local_error_sum);
  EXPECT_GT(*summary.local_error_sum, 0.5 * error);
  EXPECT_LT(*summary.local_error_sum, 5 * error);
  const Scene exact = load_scene("four-bar:1");
  EXPECT_FALSE(run(exact, test::reference(), settings).local_error_sum);
}

TEST(LocalErrors, OfHigherOrdersAreFoundByHalfSteps) {
  const Scene scene = shipped("point_mass_pendulum.json");
  for (const Scheme scheme : {Scheme::rattle4, Scheme::rattle6}) {
    const RunSummary coarse =
        run(scene, test::reference(), settings_for(scene, scheme, 0.15, 60.0));
    EXPECT_EQ(coarse.status, RunStatus::degraded) << static_cast<int>(scheme);
    RunSettings fine = settings_for(scene, scheme, 0.02, 5.0);
    const RunSummary sound = run(scene, test::reference(), fine);
    EXPECT_EQ(sound.status, RunStatus::plausible) << sound.reason;
    fine.half_step = half_of(scene, fine.step);
    const double error = *run(scene, test::reference(), fine).position_error_estimate;
    EXPECT_GT(*sound.local_error_sum, 0.1 * error) << static_cast<int>(scheme);
    EXPECT_LT(*sound.local_error_sum, 30 * error) << static_cast<int>(scheme);
  }
}

TEST(LocalErrors, CountWhatAWrongEnergyIsAheadBy) {
  const Scene scene = shipped("pendulum.json");
  const State initial = initial_state(scene.model);
  State moving = initial;
  moving.v[0] += 2.0;
  Judge judge(scene, moving, 0.0);
  judge.add_time(1.0, 1.0);
  EXPECT_EQ(judge.ahead_max(), 0.0);
  State faster = moving;
  for (double& v : faster.v) v *= 1.01;
  judge.judge(0.1, faster);
  double speed = 0.0;
  for (const double v : faster.v) speed = std::hypot(speed, v);
  judge.add_time(1.0, speed);
  // Ten steps of 0.1 s at the speed of the last, which is to the first as 1.01 to 1.
  const double ahead = speed * (std::sqrt(2 - 1 / 1.0201) - 1);
  EXPECT_NEAR(judge.ahead_max(), ahead, 1e-12);
  // Then five with too little, which take it back behind where it should be; the farthest counts.
  State slower = moving;
  for (double& v : slower.v) v *= 0.99;
  judge.judge(0.2, slower);
  judge.add_time(0.5, speed);
  EXPECT_NEAR(judge.ahead_max(), ahead, 1e-12);
  judge.add_time(9.5, speed);
  EXPECT_NEAR(judge.ahead_max(), 10 * speed * (1 - std::sqrt(2 - 1 / 0.9801)) - ahead, 1e-10);
}

TEST(LocalErrors, OfAMotionThatIsAheadAndThenBehindAreNotBoth) {
  // Its energy is too large for a part of each turn and too small for the rest.
  const Scene scene = shipped("problems/spatial_slider_crank.json");
  RunSettings settings = settings_for(scene, Scheme::saddle_point, 1e-3, 4.0);
  settings.step.tolerance = automatic_tolerance(scene.model, settings.step);
  const RunSummary summary = run(scene, test::reference(), settings);
  EXPECT_EQ(summary.status, RunStatus::plausible) << summary.reason;
}

TEST(LocalErrors, OfAPartThatADriverElsewhereDoesNotTouchShowInItsEnergy) {
  // A mass on a stop, which lasts a few steps of hundreds. Beside it a crank is driven.
  const Scene scene = scene_of(nlohmann::json::parse(R"({"points": [
      {"name": "F", "position": [0, -1], "fixed": true}, {"name": "B", "position": [0, 0]},
      {"name": "K", "position": [3, 0], "fixed": true}, {"name": "X", "position": [4, 0], "fixed": true},
      {"name": "M", "position": [3.5, 0]}],
      "masses": [{"point": "B", "mass": 1}],
      "rods": [{"name": "crank", "between": ["K", "M"], "mass": 1}],
      "constraints": [{"name": "drive", "type": "angle", "first": ["K", "X"], "second": ["K", "M"],
                       "value": {"polynomial": [0, 2]}}],
      "force_laws": [{"name": "stop", "between": ["F", "B"], "by_length": {
                      "lengths": [0.49, 0.5, 0.51, 0.6], "forces": [-10000, 0, 0, 0]}}]})"),
                               "test");
  RunSettings settings = settings_for(scene, Scheme::penalty, 2.5e-3, 10.0);
  EXPECT_NE(run(scene, test::reference(), settings).status, RunStatus::plausible);
  settings.duration = 0.3;  // before its first hit
  const RunSummary sound = run(scene, test::reference(), settings);
  EXPECT_EQ(sound.status, RunStatus::plausible) << sound.reason;
}

TEST(LocalErrors, DampersBringNoEnergy) {
  // A mass on a stop with a damper, which lasts less than a step.
  const Scene scene = scene_of(nlohmann::json::parse(R"({"points": [
      {"name": "F", "position": [0, -1], "fixed": true}, {"name": "B", "position": [0, 0]}],
      "masses": [{"point": "B", "mass": 1}],
      "force_laws": [{"name": "stop", "between": ["F", "B"],
                      "by_length": {"lengths": [0.49, 0.5, 0.51, 0.6], "forces": [-10000, 0, 0, 0]},
                      "by_rate": {"rates": [-10, 0, 10], "forces": [-0.2, 0, 0.2]}}]})"),
                               "test");
  RunSettings settings = settings_for(scene, Scheme::penalty, 5e-3, 10.0);
  const RunSummary coarse = run(scene, test::reference(), settings);
  EXPECT_EQ(coarse.status, RunStatus::diverged);
  EXPECT_NE(coarse.reason.find("energy of a part"), std::string::npos) << coarse.reason;
  settings.duration = 0.3;  // before its first hit
  const RunSummary sound = run(scene, test::reference(), settings);
  EXPECT_EQ(sound.status, RunStatus::plausible) << sound.reason;
}

/// Two rods of 1 m below each other, of 1 kg and of `mass`.
Scene with_lower_rod(double mass) {
  nlohmann::json scene = nlohmann::json::parse(R"({"points": [
      {"name": "A", "position": [0, 0], "fixed": true},
      {"name": "B", "position": [0.8, -0.6]}, {"name": "C", "position": [1.6, -1.2]}],
      "rods": [{"name": "upper", "between": ["A", "B"], "mass": 1, "length": 1},
               {"name": "lower", "between": ["B", "C"], "length": 1}]})");
  scene["rods"][1]["mass"] = mass;
  return scene_of(scene, "test");
}

/// How often a run of `steps` steps makes a simulation that does steps again.
int made_again(const Scene& scene, RunSettings settings, long steps) {
  settings.duration = static_cast<double>(steps) * settings.step.step;
  const Variant variant = test::reference();
  const auto simulation = variant.create(scene.model, settings.step);
  const State start = initial_state(scene.model);
  simulation->set_state(start);
  int made = 0;
  JudgedRun judged(scene, settings, start, {});
  judged.begin({[&](State& state) { simulation->get_state(state); },
                [&]() -> Simulation& { return *simulation; },
                [&](const StepSettings& step) {
                  ++made;
                  return variant.create(scene.model, step);
                },
                &scene.model});
  while (!judged.is_over()) judged.take(simulation->step());
  EXPECT_EQ(judged.finish().steps, steps);
  return made;
}

TEST(LocalErrors, AreNotLookedForWhereTheToleranceLeavesNone) {
  const Scene scene = shipped("double_pendulum.json");
  RunSettings settings = settings_for(scene, Scheme::penalty, 1e-3, 1.0);
  settings.step.tolerance = 1e-9;
  EXPECT_EQ(made_again(scene, settings, 200), 0);
  EXPECT_EQ(made_again(scene, settings, 4000), 1);  // what a step may leave adds up
  RunSettings loose = settings, kept = settings, limited = settings;
  loose.step.tolerance = 1e-6;
  EXPECT_EQ(made_again(scene, loose, 200), 1);
  kept.step.tangent = TangentReuse::kept;  // the tangent is older than a correction
  kept.step.penalty = automatic_penalty(scene.model, kept.step);
  EXPECT_EQ(made_again(scene, kept, 200), 1);
  limited.step.max_passes = 1;  // steps do not get to the tolerance
  EXPECT_EQ(made_again(scene, limited, 200), 1);
}

TEST(LocalErrors, AddUpAlongTheWay) {
  const Scene scene = shipped("pendulum.json");
  ASSERT_EQ(scene.model.variables(), 2);
  const std::vector<double> onward{2.0, 0.0}, none{0.0, 0.0};
  const std::vector<bool> one{false, false};
  LocalErrors lags(scene, 1.0, one);
  lags.add(std::vector{1e-3, 5.0}, onward, 1e-3, 10);  // what is across the way is no lag
  EXPECT_NEAR(lags.worst().sum, 1e-2, 1e-15);
  lags.add(std::vector{1e-3, 5.0}, none, 1e-3, 10);
  EXPECT_NEAR(lags.worst().sum, 1e-2, 1e-15);
  lags.add(std::vector{std::numeric_limits<double>::quiet_NaN(), 0.0}, onward, 1e-3, 1);
  EXPECT_EQ(lags.worst().sum, HUGE_VAL);
  // Each of 1000 steps leaves the speed by 1e-6 m/s too high: by 1e-3 m/s at last, half of that on
  // the mean, over 1 s. The walk that it may be besides is 1e-6 sqrt(N).
  LocalErrors speeds(scene, 1.0, one), shaken(scene, 1.0, one), brief(scene, 1.0, one);
  for (int i = 0; i < 100; ++i) {
    speeds.add_speed({{1e-6, 5.0}, {1e-6, 0.0}}, onward, 1e-3, 10, 0.0);
    const double error = i % 2 == 0 ? 1e-6 : -1e-6;
    shaken.add_speed({{error, 5.0}, {error, 0.0}}, onward, 1e-3, 10, 0.0);
    brief.add_speed({{1e-6, 5.0}, {-1e-7, 0.0}}, onward, 1e-3, 10, 0.0);
  }
  EXPECT_GT(speeds.worst().sum, 3e-4);
  EXPECT_LT(speeds.worst().sum, 6e-4);
  EXPECT_LT(shaken.worst().sum, 5e-5);
  EXPECT_EQ(brief.worst().sum, 0.0);    // a stiff damper turned it round
  LocalErrors braked(scene, 1.0, one);  // as if all was taken away before each sample
  for (int i = 0; i < 100; ++i) {
    braked.add_speed({{1e-6, 5.0}, {1e-6, 5.0}}, onward, 1e-3, 10, 1e6);
  }
  EXPECT_LT(braked.worst().sum, 1e-5);
  speeds.add_speed({{1.0, 0.0}, {1.0, 0.0}}, onward, 1e-3, 1000,
                   0.0);  // no more than the way itself
  EXPECT_LT(speeds.worst().sum, 6e-4 + 2.0 * 1e-3 * 1000 + 1e-12);
}

TEST(LocalErrors, ALagIsATime) {
  const Scene scene = shipped("pendulum.json");
  const std::vector<double> slow{0.1, 0.0}, fast{2.0, 0.0}, none{0.0, 0.0};
  LocalErrors lags(scene, 1.0, {false, false});
  lags.add(std::vector{1e-6, 0.0}, slow, 1e-3, 100);  // 1e-3 s late
  EXPECT_NEAR(lags.worst().sum, 1e-4, 1e-18);
  lags.add(none, fast, 1e-3, 1);
  lags.add(none, slow, 1e-3, 1);
  EXPECT_NEAR(lags.worst().sum, 2e-3, 1e-17);
}

TEST(LocalErrors, OfAMotionThatExcitesItselfGrowWithIt) {
  // Pushed where it is slow and held back where it is fast, a mass oscillates more and more.
  const Scene scene = scene_of(nlohmann::json::parse(R"({"gravity": [0, 0],
      "points": [{"name": "A", "position": [0, 0], "fixed": true}, {"name": "P", "position": [1.0001, 0]}],
      "masses": [{"point": "P", "mass": 1}],
      "springs": [{"between": ["A", "P"], "stiffness": 39.4784, "length": 1}],
      "constraints": [{"type": "linear", "terms": [{"point": "P", "axis": "y", "coefficient": 1}]}],
      "force_laws": [{"between": ["A", "P"], "by_rate": {"rates": [-4, -2, -1, 0, 1, 2, 4],
                                                         "forces": [-12, 0, 1.2, 0, -1.2, 0, 12]}}]})"),
                               "test");
  RunSettings settings = settings_for(scene, Scheme::penalty, 0.01, 16.0);
  settings.half_step = half_of(scene, settings.step);
  EXPECT_GT(*run(scene, test::reference(), settings).position_error_estimate, 0.01);
  settings.half_step.reset();
  EXPECT_EQ(run(scene, test::reference(), settings).status, RunStatus::degraded);
}

TEST(LocalErrors, ShiftsOfTheSpeedGoOn) {
  const Scene scene = shipped("pendulum.json");
  const std::vector<double> onward{2.0, 0.0}, off{3e-6, 4e-6}, none{0.0, 0.0};
  const std::vector<bool> more{true, true};
  LocalErrors even(scene, 1.0, more), once(scene, 1.0, more);
  even.add(off, onward, 1e-3, 1000);
  // 1000 steps off by 5e-6 m, also across the way, and 1 s with the speed 5e-3 m/s too high.
  EXPECT_NEAR(even.worst().sum, 5e-3 + 5e-3, 1e-12);
  // What was left in the first of four seconds goes on, as its root mean square.
  once.add(off, onward, 1e-3, 1000);
  EXPECT_EQ(once.add(none, onward, 1e-3, 3000), 2.0);
  EXPECT_NEAR(once.worst().sum, 5e-3 + 4 * 5e-3 / 2, 1e-12);
  even.add(std::vector{std::numeric_limits<double>::quiet_NaN(), 0.0}, onward, 1e-3, 1);
  EXPECT_EQ(even.worst().sum, HUGE_VAL);
}

/// Two rods in space on a ball joint each.
nlohmann::json double_in_space() {
  return nlohmann::json::parse(R"({"dimension": 3, "gravity": [0, 0, -9.81],
      "points": [{"name": "A", "position": [0, 0, 0], "fixed": true},
                 {"name": "B", "position": [-0.41, -0.08, 0.19]},
                 {"name": "C", "position": [-0.13, -0.19, 0.034]}],
      "rods": [{"name": "upper", "between": ["A", "B"], "mass": 0.3},
               {"name": "lower", "between": ["B", "C"], "mass": 0.8}],
      "masses": [{"point": "B", "mass": 0.25}, {"point": "C", "mass": 0.7}]})");
}

TEST(LocalErrors, OfFreedomsThatPassEnergyOnToEachOtherGrow) {
  // Energy is right in all, not in each.
  const Scene scene = scene_of(double_in_space(), "test");
  RunSettings settings = settings_for(scene, Scheme::saddle_point, 1e-3, 4.0);
  const RunSummary coarse = run(scene, test::reference(), settings);
  EXPECT_EQ(coarse.status, RunStatus::degraded);
  EXPECT_LT(*coarse.energy_drift_max, 1e-3);
  settings.half_step = half_of(scene, settings.step);
  const RunSummary estimated = run(scene, test::reference(), settings);
  EXPECT_GT(*estimated.position_error_estimate, 0.01 * judged_length(scene.model));
  settings.half_step.reset();
  settings.step = half_of(scene, half_of(scene, settings.step));
  const RunSummary fine = run(scene, test::reference(), settings);
  EXPECT_EQ(fine.status, RunStatus::plausible) << fine.reason;
}

TEST(LocalErrors, OfFreedomsThatPassEnergyOnGrowBesideALoop) {
  nlohmann::json scene = double_in_space();
  const auto beside = nlohmann::json::parse(R"({
      "points": [{"name": "K", "position": [3, 0, 0], "fixed": true},
                 {"name": "D", "position": [3.9, 0, 0], "fixed": true},
                 {"name": "E", "position": [3.5, 0, 0.6]}, {"name": "F", "position": [3.9, 0.8, 0]}],
      "rods": [{"name": "crank", "between": ["K", "E"], "mass": 1},
               {"name": "coupler", "between": ["E", "F"], "mass": 1},
               {"name": "rocker", "between": ["D", "F"], "mass": 1}],
      "constraints": [
          {"name": "z", "type": "linear", "terms": [{"point": "F", "axis": "z", "coefficient": 1}], "value": 0},
          {"name": "y", "type": "linear", "terms": [{"point": "E", "axis": "y", "coefficient": 1}], "value": 0}]})");
  for (const char* list : {"points", "rods"}) {
    scene[list].insert(scene[list].end(), beside[list].begin(), beside[list].end());
  }
  scene["constraints"] = beside["constraints"];
  for (const char* tie : {"[]", R"([{"between": ["C", "F"], "stiffness": 1e-9, "length": 1}])"}) {
    scene["springs"] = nlohmann::json::parse(tie);
    const Scene both = scene_of(scene, "test");
    EXPECT_EQ(
        run(both, test::reference(), settings_for(both, Scheme::saddle_point, 1e-3, 4.0)).status,
        RunStatus::degraded)
        << tie;
  }
}

TEST(LocalErrors, OfASmallPartAreMeasuredByIt) {
  // A needle that begins at rest and lags behind by a fifth of its length, alone and with a large
  // rod beside it that nothing connects with it.
  nlohmann::json small = nlohmann::json::parse(R"({"gravity": [0, 0], "points": [
      {"name": "S", "position": [0, 0], "fixed": true},
      {"name": "X", "position": [1, 0], "fixed": true}, {"name": "T", "position": [0.01, 0]}],
      "rods": [{"name": "needle", "between": ["S", "T"], "mass": 0.1}],
      "torque_laws": [{"from": ["S", "X"], "to": ["S", "T"],
          "by_rate": {"rates": [-1000, 1000], "torques": [-1, -1]},
          "factor": {"sine": {"amplitude": 3.3333e-5, "frequency": 0.1}}}]})");
  const auto judged = [](const nlohmann::json& document) {
    const Scene scene = scene_of(document, "test");
    RunSettings settings = settings_for(scene, Scheme::penalty, 5e-3, 10.0);
    const RunSummary alone = run(scene, test::reference(), settings);
    EXPECT_EQ(alone.status, RunStatus::degraded);
    EXPECT_NE(alone.reason.find("the length at T"), std::string::npos) << alone.reason;
    settings.half_step = half_of(scene, settings.step);
    EXPECT_EQ(run(scene, test::reference(), settings).status, RunStatus::degraded);
    return lengths_of_points(scene, judged_length(scene.model));
  };
  EXPECT_EQ(judged(small), std::vector{0.01});
  small["points"].push_back({{"name", "B"}, {"position", {1, 1}}, {"velocity", {1, 0}}});
  small["rods"].push_back({{"name", "rod"}, {"between", {"X", "B"}}, {"mass", 1}});
  EXPECT_EQ(judged(small), (std::vector{0.01, 1.0}));
}

TEST(LocalErrors, OfHigherOrdersGrowWhereFreedomsPassEnergyOn) {
  const Scene scene = scene_of(double_in_space(), "test");
  const RunSummary coarse =
      run(scene, test::reference(), settings_for(scene, Scheme::rattle4, 1e-2, 4.0));
  EXPECT_EQ(coarse.status, RunStatus::degraded);
  EXPECT_LT(*coarse.energy_drift_max, 1e-3);
  const RunSummary fine =
      run(scene, test::reference(), settings_for(scene, Scheme::rattle4, 2.5e-3, 4.0));
  EXPECT_EQ(fine.status, RunStatus::plausible) << fine.reason;
}

TEST(LocalErrors, OfALightPartAreItsOwn) {
  const Scene scene = with_lower_rod(1e-6);
  const RunSummary shaken =
      run(scene, test::reference(), settings_for(scene, Scheme::penalty, 1e-2, 2.0));
  EXPECT_EQ(shaken.status, RunStatus::degraded);
  EXPECT_LT(*shaken.energy_drift_max, 1e-3);
  EXPECT_NE(shaken.reason.find("local errors"), std::string::npos) << shaken.reason;
  const RunSummary sound =
      run(scene, test::reference(), settings_for(scene, Scheme::saddle_point, 1.25e-3, 2.0));
  EXPECT_EQ(sound.status, RunStatus::plausible) << sound.reason;
}

TEST(LocalErrors, SeeWhatPassesThatEndEarlyLeave) {
  // A rod that turns about its foot without gravity and is braked.
  const Scene scene = scene_of(nlohmann::json::parse(R"({"gravity": [0, 0], "points": [
      {"name": "A", "position": [0, 0], "fixed": true},
      {"name": "X", "position": [1, 0], "fixed": true},
      {"name": "B", "position": [1, 0], "velocity": [0, 3]}],
      "rods": [{"name": "rod", "between": ["A", "B"], "mass": 1, "length": 1}],
      "torsion_springs": [{"name": "brake", "from": ["A", "X"], "to": ["A", "B"], "stiffness": 0,
                           "damping": 0.4, "angle": 1}]})"),
                               "test");
  RunSettings settings = settings_for(scene, Scheme::penalty, 5e-3, 5.0);
  settings.step.tolerance = 1e-6;
  settings.step.tangent = TangentReuse::kept;
  settings.step.penalty = automatic_penalty(scene.model, settings.step);
  EXPECT_EQ(run(scene, test::reference(), settings).status, RunStatus::degraded);
  settings.step.tolerance = 1e-12;
  const RunSummary sound = run(scene, test::reference(), settings);
  EXPECT_EQ(sound.status, RunStatus::plausible) << sound.reason;
}

TEST(LocalErrors, DoNotAddUpWhereDriversLeaveNoFreedom) {
  const Scene scene = shipped("examples/driven_crank.json");
  const RunSummary summary =
      run(scene, test::reference(), settings_for(scene, Scheme::penalty, 2e-2, 2.0));
  EXPECT_FALSE(summary.local_error_sum);
  EXPECT_EQ(summary.status, RunStatus::plausible) << summary.reason;
}

/// At 2 pi rad a `period` steps, in unit steps of a millisecond.
Scene spring_of_period(double period) {
  const double rate = 2 * std::acos(-1.0) / (period * 1e-3);
  return test::oscillator(rate * rate, 0.0, 10.0, 11.0);
}

TEST(LocalErrors, AMotionInStepWithTheJudgeIsSeen) {
  const Scene scene = spring_of_period(32);
  RunSettings settings;
  settings.step = chosen(scene.model, {.step = 1e-3});
  settings.duration = 0.096;
  settings.judge_every = 32;
  EXPECT_EQ(run(scene, test::reference(), settings).status, RunStatus::degraded);
  settings.half_step = settings.step;
  settings.half_step->step /= 2;
  const RunSummary estimated = run(scene, test::reference(), settings);
  // The lag of the trapezoidal rule, (w dt)^2/12 of w t, at the fastest point of the way.
  const double turn = 2 * std::acos(-1.0) / 32;
  EXPECT_NEAR(*estimated.position_error_estimate, turn * turn / 12 * turn * 96, 0.1 * turn);
  EXPECT_EQ(estimated.status, RunStatus::degraded);
}

TEST(Run, IsNotLostBecauseItWasJudgedSeldom) {
  // Seldom judged, the largest kinetic energy is met late, and drift looks large until then.
  const Scene scene = shipped("point_mass_pendulum.json");
  RunSettings settings = settings_for(scene, Scheme::penalty, 0.07, 20.0);
  settings.judge_every = 1;
  const RunSummary often = run(scene, test::reference(), settings);
  EXPECT_EQ(often.status, RunStatus::degraded) << often.reason;
  for (const int every : {8, 16, 32, 64}) {
    settings.judge_every = every;
    const RunSummary seldom = run(scene, test::reference(), settings);
    EXPECT_EQ(seldom.status, often.status) << every << ": " << seldom.reason;
    EXPECT_EQ(seldom.steps, often.steps);
  }
}

}  // namespace
}  // namespace mbs
