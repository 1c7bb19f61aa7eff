// The gate holds batches against the reference, and rejects each defect for the right reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "check/batch_checks.hpp"
#include "check/gate.hpp"
#include "check/varied_lanes.hpp"
#include "controls/batches.hpp"
#include "ladder/term_models.hpp"
#include "model_math/kinematics.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

Variant batch_named(const std::string& name) {
  const std::vector<Variant> variants = test::batches();
  return *std::ranges::find(variants, name, &Variant::name);
}

Verdict check_batch(const std::string& name, const std::string& scene_name) {
  const Variant variant = batch_named(name);
  const Scene scene = load_scene(scene_name);
  const StepSettings settings = chosen(scene.model);
  return check_implementation(scene, {"batch/" + name, nullptr, &variant}, settings,
                              run_reference(scene, settings), {.seconds = 400.0});
}

const Check& check_named(const Verdict& verdict, const std::string& name) {
  const auto check = std::ranges::find(verdict.checks, name, &Check::name);
  if (check == verdict.checks.end()) throw std::invalid_argument("no check is called " + name);
  return *check;
}

TEST(BatchChecks, ASoundBatchAgrees) {
  const std::string folder = MBS_ROOT "/harness/scenes/";
  for (const std::string& scene :
       {std::string("four-bar:2"), folder + "double_pendulum.json",
        folder + "problems/slider_crank.json", folder + "problems/a04_bricard.json",
        folder + "problems/half_car.json"}) {
    SCOPED_TRACE(scene);
    const Verdict verdict = check_batch("sound", scene);
    EXPECT_EQ(verdict.verdict, "agrees") << verdict.reason;
    EXPECT_LE(check_named(verdict, "batch").value.value(), 1.0);
    EXPECT_EQ(check_named(verdict, "batch-running").value, 0.0);
    EXPECT_EQ(check_named(verdict, "batch-running").detail, "m; 400 steps of 3 and 11 lanes");
  }
}

TEST(BatchChecks, DefectsAreRejected) {
  const struct {
    const char *name, *verdict, *reason;
  } cases[] = {
      {"lost_lane", "disagrees",
       "^batch-running: lane 2 of 3: q differs by nan m first at step 40$"},
      {"failed_lane", "disagrees",
       "^batch-running: lane 2 of 3: factorization failed first at step 40$"},
      {"throws", "crashed", "^threw the batch is lost$"},
      {"leaks", "disagrees", "^batch: lane 1 of 3: q differs by "},
      {"mixes", "disagrees", R"(^batch: lane \d+ of \d+: . differs by .* after one step)"},
  };
  for (const auto& [name, expected, reason] : cases) {
    const Verdict verdict = check_batch(name, "four-bar:2");
    EXPECT_EQ(verdict.verdict, expected) << name << ": " << verdict.reason;
    EXPECT_TRUE(std::regex_search(verdict.reason, std::regex(reason)))
        << name << ": " << verdict.reason;
  }
}

TermModel everything_in_space() {
  std::vector<TermModel> models = term_models();
  return *std::ranges::find(models, "everything and force laws, spatial", &TermModel::name);
}

TEST(BatchChecks, WhateverIsThatOfLane0IsRejected) {
  const TermModel term = everything_in_space();
  const StepSettings settings = term_settings(term.model);
  const ReferenceRun reference = run_reference({term.name, term.model, {}, {}}, settings, 16);
  int count = 0;
  for (const Variant& variant : test::batches()) {
    const bool is_sound = variant.name == "sound";
    if (!is_sound && !variant.name.starts_with("mixes")) continue;
    const auto checks = batch_checks(variant, term.model, settings, reference, 60.0);
    EXPECT_EQ(checks[0].passed, is_sound) << variant.name << ": " << checks[0].detail;
    ++count;
  }
  EXPECT_EQ(count, 13);
}

TEST(VaryLanes, StartOnTheirConstraints) {
  for (const TermModel& term : term_models()) {
    const StepSettings settings = term_settings(term.model);
    const VariedLanes lanes = vary_lanes(3, 0.04, term.model, settings, initial_state(term.model));
    for (int k = 0; k < lanes.count(); ++k) {
      const Model& model = *lanes.models[static_cast<std::size_t>(k)];
      const State& start = lanes.starts[static_cast<std::size_t>(k)];
      std::vector<double> phi(static_cast<std::size_t>(model.constraints())), rate(phi);
      evaluate_constraints(model, start.t, start.q, phi);
      constraint_rate(model, start.t, start.q, start.v, rate);
      for (const double x : phi) EXPECT_NEAR(x, 0.0, 1e-12) << term.name << ", lane " << k;
      for (const double x : rate) EXPECT_NEAR(x, 0.0, 1e-9) << term.name << ", lane " << k;
    }
  }
}

TEST(BatchChecks, ABatchThatIsRefusedIsNotChecked) {
  const Verdict verdict = check_batch("unsupported", "four-bar:2");
  EXPECT_EQ(verdict.verdict, "agrees") << verdict.reason;
  EXPECT_FALSE(check_named(verdict, "batch").passed);
  EXPECT_EQ(check_named(verdict, "batch").detail, "no batches today");
}

TEST(BatchChecks, NoTimeIsNoDisagreement) {
  const Scene scene = load_scene("four-bar:2");
  const StepSettings settings = chosen(scene.model);
  const auto checks = batch_checks(batch_named("sound"), scene.model, settings,
                                   run_reference(scene, settings, 16), 0.0);
  ASSERT_EQ(checks.size(), 2U);
  EXPECT_EQ(checks[0].passed, true);
  EXPECT_EQ(checks[1].passed, std::nullopt);
  EXPECT_NE(checks[1].detail.find("a longer --time-limit"), std::string::npos);
}

}  // namespace
}  // namespace mbs
