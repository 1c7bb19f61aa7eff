// Jumps to another assembly are found, and passages of singular positions are not called jumps.
#include "run/branch_watch.hpp"

#include <gtest/gtest.h>

#include "controls/controls.hpp"
#include "model_math/closed_parts.hpp"
#include "run/initial_state.hpp"
#include "run/judge.hpp"
#include "run/rounding.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

TEST(ClosedParts, FindTheLoopsOfAFourBar) {
  const Scene scene = load_scene(MBS_ROOT "/harness/scenes/four_bar_2.json");
  const State start = initial_state(scene.model);
  const ClosedParts parts = closed_parts(scene.model, start.q, 60);
  EXPECT_TRUE(parts.driven.rows.empty());
  ASSERT_EQ(parts.free.size(), 1U);
  EXPECT_EQ(parts.free[0].cols.size(), parts.free[0].rows.size() + 1);
  EXPECT_TRUE(closed_parts(scene.model, start.q, 2).free.empty());
}

TEST(ClosedParts, AreNoneOfAnOpenChain) {
  const Scene scene = load_scene("chain:5");
  const ClosedParts parts = closed_parts(scene.model, initial_state(scene.model).q, 60);
  EXPECT_TRUE(parts.free.empty());
  EXPECT_TRUE(parts.blocks.empty());
}

TEST(BranchWatch, FindsAMirroredDyad) {
  const Scene scene = load_scene(MBS_ROOT "/harness/scenes/examples/driven_crank.json");
  const State start = initial_state(scene.model);
  BranchWatch watch(scene, start, judged_length(scene.model), true);
  ASSERT_TRUE(watch.is_needed());
  EXPECT_EQ(watch.look(1e-9, start), "");
  // F on the other side of the line from E to the foot.
  State jumped = start;
  const double ex = start.q[0], ey = start.q[1], fx = start.q[2], fy = start.q[3];
  const double ux = 1.2 - ex, uy = -ey,
               share = ((fx - ex) * ux + (fy - ey) * uy) / (ux * ux + uy * uy);
  jumped.q[2] = 2 * (ex + share * ux) - fx;
  jumped.q[3] = 2 * (ey + share * uy) - fy;
  EXPECT_TRUE(watch.is_across(2e-9, jumped));
  const std::string found = watch.look(2e-9, jumped);
  EXPECT_NE(found.find("arm"), std::string::npos) << found;
  EXPECT_NE(found.find("another assembly"), std::string::npos) << found;
}

TEST(BranchWatch, LetsALoopPassItsSingularPositions) {
  Scene scene = load_scene("four-bar:1");
  scene.four_bar_loops.reset();  // as if nothing were known of it
  RunSettings settings;
  settings.step.penalty = automatic_penalty(scene.model, settings.step);
  settings.duration = 2.0;
  const RunSummary summary = run(scene, test::reference(), settings);
  EXPECT_EQ(summary.status, RunStatus::plausible) << summary.reason;
  settings.half_step = settings.step;
  settings.half_step->step /= 2;
  settings.half_step->penalty = automatic_penalty(scene.model, *settings.half_step);
  const RunSummary estimated = run(scene, test::reference(), settings);
  EXPECT_EQ(estimated.status, RunStatus::plausible) << estimated.reason;
  EXPECT_NE(estimated.reason.find("singular position"), std::string::npos) << estimated.reason;
}

TEST(Rounding, ShakesLightPartsInThePenaltyForm) {
  const Scene scene = load_scene(MBS_ROOT "/harness/scenes/double_pendulum.json");
  StepSettings settings;
  settings.step = 1e-3;
  settings.penalty = automatic_penalty(scene.model, settings);
  EXPECT_EQ(rounding_degradation(scene.model, settings, 10'000, 1.0), "");
  ModelData light = scene.model.data();
  for (MassEntry& entry : light.mass) entry.value *= 1e-8;
  const Model model(std::move(light));
  EXPECT_NE(rounding_degradation(model, settings, 10'000, 1.0).find("saddle-point"),
            std::string::npos);
  settings.scheme = Scheme::saddle_point;
  EXPECT_EQ(rounding_degradation(model, settings, 10'000, 1.0), "");
}

}  // namespace
}  // namespace mbs
