// Energy against work: what holds in sound runs of damped and driven scenes, and what is seen.
#include "run/power_balance.hpp"

#include <gtest/gtest.h>

#include "controls/controls.hpp"
#include "model_math/kinematics.hpp"
#include "run/initial_state.hpp"
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
    settings.step.scheme = Scheme::saddle_point;
    settings.step.step = step;
    settings.step.penalty = automatic_penalty(scene.model, settings.step);
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

TEST(PowerBalance, IsNoQuestionWhereEnergyIsConservedOrDriversSetAll) {
  for (const char* name : {"double_pendulum.json", "examples/driven_crank.json"}) {
    const Scene scene = shipped(name);
    RunSettings settings;
    settings.step.penalty = automatic_penalty(scene.model, settings.step);
    settings.duration = 0.1;
    EXPECT_FALSE(run(scene, test::reference(), settings).imbalance_max) << name;
  }
}

}  // namespace
}  // namespace mbs
