// Energy against work: what holds in sound runs of damped and driven scenes, and what is seen.
#include "run/power_balance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "controls/controls.hpp"
#include "model_math/even_carriage.hpp"
#include "model_math/kinematics.hpp"
#include "run/initial_state.hpp"
#include "run/judge.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

Scene shipped(const std::string& name) { return load_scene(MBS_ROOT "/harness/scenes/" + name); }

TEST(PowerBalance, HoldsInSoundRuns) {
  const struct {
    const char* name;
    double step, duration;
  } cases[] = {{"problems/half_car.json", 1e-3, 2.0},
               {"examples/quarter_car.json", 5e-4, 2.0},
               {"problems/a03_andrews.json", 2e-6, 0.01},
               {"examples/bump_stop.json", 2e-4, 2.0}};
  for (const auto& [name, step, duration] : cases) {
    const Scene scene = shipped(name);
    RunSettings settings;
    settings.step = chosen(scene.model, {.step = step, .scheme = Scheme::saddle_point});
    settings.duration = duration;
    const RunSummary summary = run(scene, test::reference(), settings);
    ASSERT_TRUE(summary.imbalance_max) << name << summary.reason;
    EXPECT_LT(*summary.imbalance_max, 1e-2) << name;
    EXPECT_FALSE(summary.energy_drift_max) << name;
  }
}

TEST(PowerBalance, SeesEnergyThatNothingBrought) {
  const Scene scene = shipped("examples/quarter_car.json");
  const State before = initial_state(scene.model);
  State after = before;
  for (double& v : after.v) v += 0.1;
  PowerBalance balance(scene);
  const double gained =
      kinetic_energy(scene.model, after.v) - kinetic_energy(scene.model, before.v);
  EXPECT_NEAR(balance.over(before, after, 1e-9, 1e-9).excess, gained, 1e-4 * gained);
  EXPECT_NEAR(balance.over(before, before, 1e-9, 1e-9).excess, 0.0, 1e-4 * gained);
}

TEST(PowerBalance, KnowsWhatDampersTake) {
  // A rod of inertia 1/3 about its foot, braked by 0.4 N m s: that takes 2 c/I of its energy.
  const Scene scene = scene_of(nlohmann::json::parse(R"({"points": [
      {"name": "A", "position": [0, 0], "fixed": true},
      {"name": "X", "position": [1, 0], "fixed": true},
      {"name": "B", "position": [1, 0], "velocity": [0, 3]}],
      "rods": [{"name": "rod", "between": ["A", "B"], "mass": 1, "length": 1}],
      "torsion_springs": [{"name": "brake", "from": ["A", "X"], "to": ["A", "B"], "stiffness": 5,
                           "damping": 0.4, "angle": 1}]})"),
                               "test");
  State state = initial_state(scene.model);
  PowerBalance balance(scene);
  EXPECT_NEAR(balance.braked(0.0, state), 2.4, 1e-12);
  for (double& v : state.v) v = 0.0;
  EXPECT_EQ(balance.braked(0.0, state), 0.0);
}

TEST(PowerBalance, IsNoQuestionWhereEnergyIsConservedOrDriversSetAll) {
  for (const char* name : {"double_pendulum.json", "examples/driven_crank.json"}) {
    const Scene scene = shipped(name);
    RunSettings settings;
    settings.step = chosen(scene.model);
    settings.duration = 0.1;
    EXPECT_FALSE(run(scene, test::reference(), settings).imbalance_max) << name;
  }
}

TEST(EvenCarriage, ConservesEnergyInItsFrame) {
  const auto pendulum = [](const std::string& x, const std::string& held) {
    return scene_of(nlohmann::json::parse(R"({"gravity": [0, -3], "points": [
        {"name": "A", "position": [0, 0], )" +
                                          held + R"(},
        {"name": "B", "position": [0.6, 0.8], "velocity": [)" +
                                          x + R"(, 0.6]}],
        "rods": [{"name": "rod", "between": ["A", "B"], "mass": 1, "length": 1}]})"),
                    "test");
  };
  const Scene even = pendulum("4.2", R"("driven": {"x": {"polynomial": [0, 5]}, "y": 0})");
  const Scene uneven = pendulum("4.2", R"("driven": {"x": {"polynomial": [0, 5, 0.1]}, "y": 0})");
  const Scene still = pendulum("-0.8", R"("fixed": true)");
  RunSettings settings;
  settings.step = chosen(still.model, {.step = 1e-2, .scheme = Scheme::saddle_point});
  settings.duration = 1.0;
  const auto drift = [&](const Scene& scene) {
    return run(scene, test::reference(), settings).energy_drift_max;
  };
  ASSERT_TRUE(drift(even) && drift(still));
  EXPECT_NEAR(*drift(even), *drift(still), 1e-6);
  EXPECT_FALSE(drift(uneven));
  // A rod that turns a tenth faster about its foot than it did.
  const State start = initial_state(even.model);
  Judge judge(even, start, 0.0);
  State faster = start;
  faster.v[0] = 5 + 1.1 * (faster.v[0] - 5);
  faster.v[1] *= 1.1;
  judge.judge(0.0, faster);
  EXPECT_GT(*judge.energy_drift_max(), 0.1);
}

TEST(EvenCarriage, WhereItEndsInARunTheWorkIsJudged) {
  // Its foot rests, but for a bump between the instants at which that is looked for.
  nlohmann::json times, values;
  for (int i = 0; i <= 6000; ++i) {  // so many that the curve rests exactly at those instants
    const double t = 3e-4 * i, share = (t - 0.95) / 0.1;
    const bool is_bump = share > 0.0 && share < 1.0;
    times.push_back(t);
    values.push_back(is_bump ? 0.05 * std::pow(std::sin(std::numbers::pi * share), 4) : 0.0);
  }
  nlohmann::json document = nlohmann::json::parse(R"({"points": [
      {"name": "A", "position": [0, 0], "driven": {"x": 0}},
      {"name": "B", "position": [0.6, 0.8]}],
      "rods": [{"name": "rod", "between": ["A", "B"], "mass": 1, "length": 1}]})");
  document["points"][0]["driven"]["y"] = {{"table", {{"times", times}, {"values", values}}}};
  const Scene scene = scene_of(document, "test");
  ASSERT_TRUE(EvenCarriage::of(scene.model));
  RunSettings settings;
  settings.step = chosen(scene.model, {.step = 3e-4, .scheme = Scheme::saddle_point});
  settings.duration = 1.5;
  const RunSummary summary = run(scene, test::reference(), settings);
  EXPECT_FALSE(summary.energy_drift_max);
  ASSERT_TRUE(summary.imbalance_max) << summary.reason;
  EXPECT_LT(*summary.imbalance_max, 0.1);
  settings.duration = 0.7;
  EXPECT_TRUE(run(scene, test::reference(), settings).energy_drift_max);
}

TEST(EvenCarriage, TakesBodiesAlongWhosePointsAreDriven) {
  // Of a body with three points that others need, one of them driven, a linear row has a value that is driven too.
  const auto body = [](const std::string& first, const std::string& second) {
    return scene_of(nlohmann::json::parse(R"({"gravity": [0, -3], "points": [
        {"name": "A", "position": [0, 0], "driven": {"x": {"polynomial": [)" +
                                          first + R"(]}, "y": 0}},
        {"name": "B", "position": [1, 0], "velocity": [5, 1]},
        {"name": "C", "position": [0.5, 0.5], "velocity": [4.5, 0.5]},
        {"name": "D", "position": [3, 0], "driven": {"x": {"polynomial": [)" +
                                          second + R"(]}, "y": 0}},
        {"name": "E", "position": [4, 0], "velocity": [4.8, 1]},
        {"name": "F", "position": [1.5, 0.5], "velocity": [4.5, 1]},
        {"name": "G", "position": [2, 0], "velocity": [5, 1]}],
        "bodies": [{"name": "body", "mass": 1, "centre": [0.5, 0], "inertia": 0.1,
                    "points": {"A": [0, 0], "B": [1, 0], "C": [0.5, 0.5]}}],
        "rods": [{"name": "beside", "between": ["D", "E"], "mass": 1, "length": 1},
                 {"name": "at C", "between": ["C", "F"], "mass": 1, "length": 1},
                 {"name": "at B", "between": ["B", "G"], "mass": 1, "length": 1}]})"),
                    "test");
  };
  const Scene even = body("0, 5", "3, 5");
  ASSERT_FALSE(even.model.driven_values().empty());
  const auto carriage = EvenCarriage::of(even.model);
  ASSERT_TRUE(carriage);
  EXPECT_TRUE(carriage->holds(even.model, 2.0));
  EXPECT_FALSE(EvenCarriage::of(body("0, 5", "3, 4.8").model));
  EXPECT_FALSE(EvenCarriage::of(body("0, 5, 1", "3, 5, 1").model));
  RunSettings settings;
  settings.step = chosen(even.model, {.step = 1e-3, .scheme = Scheme::saddle_point});
  settings.duration = 1.0;
  const RunSummary sound = run(even, test::reference(), settings);
  ASSERT_TRUE(sound.energy_drift_max) << sound.reason;
  EXPECT_LT(*sound.energy_drift_max, 1e-3);
}

}  // namespace
}  // namespace mbs
