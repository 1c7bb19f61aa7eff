// Jumps to another assembly are found, and passages of singular positions are not called jumps.
#include "run/branch_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "controls/controls.hpp"
#include "model_math/block_jacobian.hpp"
#include "model_math/closed_parts.hpp"
#include "model_math/kinematics.hpp"
#include "run/initial_state.hpp"
#include "run/judge.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/run_settings.hpp"

namespace mbs {
namespace {

TEST(ClosedParts, FindTheLoopsOfAFourBar) {
  const Scene scene = load_scene(MBS_ROOT "/harness/scenes/four_bar_2.json");
  const State start = initial_state(scene.model);
  const ClosedParts parts = closed_parts(scene.model, start.q, 60);
  EXPECT_TRUE(parts.driven.empty());
  ASSERT_EQ(parts.free.size(), 1U);
  EXPECT_EQ(parts.free[0].cols.size(), parts.free[0].rows.size() + 1);
  EXPECT_TRUE(closed_parts(scene.model, start.q, 2).free.empty());
}

TEST(ClosedParts, AreNoneOfAnOpenChain) {
  const Scene scene = load_scene("chain:5");
  const ClosedParts parts = closed_parts(scene.model, initial_state(scene.model).q, 60);
  EXPECT_TRUE(parts.free.empty());
  EXPECT_TRUE(parts.driven.empty());
}

TEST(BlockJacobian, IsThePieceOfTheJacobianWhereverItIsEvaluated) {
  for (const char* name : {"examples/driven_crank.json", "problems/spatial_slider_crank.json"}) {
    const Scene scene = load_scene(std::string(MBS_ROOT "/harness/scenes/") + name);
    const Model& model = scene.model;
    ConstraintBlock all;
    for (int row = 0; row < std::min(model.constraints(), model.variables()); ++row)
      all.rows.push_back(row);
    for (int col = 0; col < model.variables(); ++col) all.cols.push_back(col);
    BlockJacobian block(model, {all});
    std::vector<double> q = initial_state(model).q;
    for (const double t : {0.0, 0.3}) {
      for (double& x : q) x += t;
      block.evaluate(t, q);
      SquareMatrix expected = SquareMatrix::Zero(model.variables(), model.variables());
      for (const JacobianEntry& entry : jacobian(model, t, q)) {
        if (entry.row < static_cast<int>(all.rows.size()))
          expected(entry.row, entry.col) = entry.value;
      }
      EXPECT_LT((block.matrix(0) - expected).cwiseAbs().maxCoeff(), 1e-14) << name << " " << t;
    }
  }
}

/// Cranks that are driven, each with a dyad: the shipped one, so many times beside each other.
Scene driven_cranks(int count) {
  auto scene = nlohmann::json::parse(R"({"assembly": {"largest_correction": 0.3}, "points": [
      {"name": "O", "position": [0, 0], "fixed": true},
      {"name": "X", "position": [1, 0], "fixed": true},
      {"name": "foot", "driven": {"x": 1.2, "y": 0}}]})");
  for (int k = 0; k < count; ++k) {
    const std::string end = std::to_string(k), e = "E" + end, f = "F" + end;
    scene["points"].push_back({{"name", e}, {"position", {0.5, 0.1}}});
    scene["points"].push_back({{"name", f}, {"position", {1.2, 0.9}}});
    const auto rod = [&](const char* name, const std::string& a, const std::string& b,
                         double length) {
      scene["rods"].push_back(
          {{"name", name + end}, {"between", {a, b}}, {"mass", 1}, {"length", length}});
    };
    rod("crank", "O", e, 0.5);
    rod("arm", e, f, 1.0);
    rod("leg", "foot", f, 0.9);
    scene["constraints"].push_back({{"name", "drive" + end},
                                    {"type", "angle"},
                                    {"first", {"O", "X"}},
                                    {"second", {"O", e}},
                                    {"value", {{"polynomial", {0, 3.0, 0.5}}}}});
  }
  return scene_of(scene, "test");
}

TEST(BranchWatch, FindsAMirroredDyadAmongAnyNumberOfDrivenOnes) {
  for (const int count : {1, 20}) {
    const Scene scene = driven_cranks(count);
    const State start = initial_state(scene.model);
    BranchWatch watch(scene, start, judged_length(scene.model), true);
    ASSERT_TRUE(watch.is_needed());
    EXPECT_EQ(watch.look(1e-9, start), "");
    // The last F on the other side of the line from E to the foot.
    State jumped = start;
    const std::size_t last = start.q.size() - 4;
    const double ex = start.q[last], ey = start.q[last + 1];
    const double fx = start.q[last + 2], fy = start.q[last + 3];
    const double ux = 1.2 - ex, uy = -ey,
                 share = ((fx - ex) * ux + (fy - ey) * uy) / (ux * ux + uy * uy);
    jumped.q[last + 2] = 2 * (ex + share * ux) - fx;
    jumped.q[last + 3] = 2 * (ey + share * uy) - fy;
    EXPECT_TRUE(watch.is_across(2e-9, jumped));
    const std::string found = watch.look(2e-9, jumped);
    EXPECT_NE(found.find("arm" + std::to_string(count - 1)), std::string::npos) << found;
    EXPECT_NE(found.find("another assembly"), std::string::npos) << found;
  }
}

TEST(ClosedParts, NeedWhatDrivesThemAlone) {
  const Scene scene = driven_cranks(3);
  const auto parts = [&](int largest) {
    return closed_parts(scene.model, initial_state(scene.model).q, largest).driven;
  };
  ASSERT_EQ(parts(4).size(), 6U);
  EXPECT_EQ(parts(3).size(), 3U);  // the cranks
  for (const ClosedParts::Driven& part : parts(60)) {
    EXPECT_EQ(part.block.rows.size(), 2U);
    EXPECT_EQ(part.all.rows.size(), 2 * part.needed.size());
    EXPECT_EQ(part.all.cols.size(), part.all.rows.size());
  }
}

TEST(BranchWatch, SaysThatASingularPositionWasPassedWhateverIsRedundantElsewhere) {
  // A four-bar as of four-bar:1; beside it a pendulum of two rods, or these and a third along both.
  auto scene = nlohmann::json::parse(R"({"points": [
      {"name": "A0", "position": [0, 0], "fixed": true},
      {"name": "A1", "position": [1, 0], "fixed": true},
      {"name": "B0", "position": [0, 1], "velocity": [1, 0]},
      {"name": "B1", "position": [1, 1], "velocity": [1, 0]},
      {"name": "P", "position": [5, 0], "fixed": true}, {"name": "Q", "position": [5, -1]},
      {"name": "R", "position": [5, -2]}],
      "rods": [{"name": "left", "between": ["A0", "B0"], "mass": 1},
               {"name": "right", "between": ["A1", "B1"], "mass": 1},
               {"name": "coupler", "between": ["B0", "B1"], "mass": 1},
               {"name": "one", "between": ["P", "Q"], "mass": 1},
               {"name": "two", "between": ["Q", "R"], "mass": 1}]})");
  for (const bool is_redundant : {false, true}) {
    if (is_redundant) {
      scene["rods"].push_back({{"name", "along"}, {"between", {"P", "R"}}, {"mass", 1}});
    }
    const Scene loaded = scene_of(scene, "test");
    const RunSettings settings =
        test::with_half_step(loaded, test::automatic_settings(loaded, 2.0));
    const RunSummary summary = run(loaded, test::reference(), settings);
    EXPECT_EQ(summary.status, RunStatus::plausible) << summary.reason;
    EXPECT_NE(summary.reason.find("singular position"), std::string::npos) << summary.reason;
  }
}

TEST(BranchWatch, LetsALoopPassItsSingularPositions) {
  Scene scene = load_scene("four-bar:1");
  scene.four_bar_loops.reset();  // as if nothing were known of it
  const RunSettings settings = test::automatic_settings(scene, 2.0);
  const RunSummary summary = run(scene, test::reference(), settings);
  EXPECT_EQ(summary.status, RunStatus::plausible) << summary.reason;
  const RunSummary estimated = run(scene, test::reference(), test::with_half_step(scene, settings));
  EXPECT_EQ(estimated.status, RunStatus::plausible) << estimated.reason;
  EXPECT_NE(estimated.reason.find("singular position"), std::string::npos) << estimated.reason;
  EXPECT_EQ(estimated.branch_doubt, estimated.reason);
  EXPECT_EQ(summary.branch_doubt, "") << "half the step was not asked";
}

TEST(BranchWatch, TakesNoDirectionFromRoundingAtRest) {
  const Scene scene = load_scene(MBS_ROOT "/harness/scenes/four_bar_2.json");
  State rest = initial_state(scene.model);
  std::ranges::fill(rest.v, 0.0);
  const auto changes = [&](double speed) {
    BranchWatch watch(scene, rest, judged_length(scene.model), true);
    bool has_changed = false;
    for (int i = 0; i < 40; ++i) {
      State state = rest;
      for (std::size_t k = 0; k < state.v.size(); ++k) {
        state.v[k] = speed * std::sin(3.0 * i * i + 2.0 * static_cast<double>(k * k) + i);
      }
      has_changed = has_changed || watch.is_across(i, state);
      if (i == 0) watch.look(i, state);
    }
    return has_changed;
  };
  EXPECT_TRUE(changes(1.0));
  EXPECT_FALSE(changes(1e-14));
}

/// A crank-rocker 1e-7 m from its change point with a light rod hanging on it; how its feet are
/// held.
Scene crank_rocker(const std::string& held_a, const std::string& held_d, double speed) {
  auto scene =
      nlohmann::json::parse(R"({"gravity": [0, 0], "points": [{"name": "A", "position": [0, 0], )" +
                            held_a + R"(}, {"name": "D", "position": [1, 0], )" + held_d + R"(},
         {"name": "B", "position": [0.21612086831702532, 0.33658830977606014]},
         {"name": "C", "position": [1.2161208683170182, 0.33658842861556915]},
         {"name": "E", "position": [1.2161208683170182, 0.63658842861556915]}],
         "rods": [{"name": "crank", "between": ["A", "B"], "mass": 1, "length": 0.3999999},
                  {"name": "coupler", "between": ["B", "C"], "mass": 1, "length": 1},
                  {"name": "rocker", "between": ["D", "C"], "mass": 1, "length": 0.4},
                  {"name": "hanging", "between": ["C", "E"], "mass": 1e-6, "length": 0.3}]})");
  scene["points"][2]["velocity"] = {speed - 0.33658830977606014, 0.21612086831702532};
  scene["points"][3]["velocity"] = {speed - 0.33658830977605086, 0.21612079201106799};
  scene["points"][4]["velocity"] = scene["points"][3]["velocity"];
  return scene_of(scene, "test");
}

Scene crank_rocker() { return crank_rocker(R"("fixed": true)", R"("fixed": true)", 0.0); }

Scene carried_crank_rocker() {
  return crank_rocker(R"("driven": {"x": {"polynomial": [0, 0.5]}, "y": 0})",
                      R"("driven": {"x": {"polynomial": [1, 0.5]}, "y": 0})", 0.5);
}

TEST(ClosedParts, LeaveOutWhatHangsOnALoop) {
  for (const Scene& scene : {crank_rocker(), carried_crank_rocker()}) {
    const ClosedParts parts = closed_parts(scene.model, initial_state(scene.model).q, 60);
    ASSERT_EQ(parts.free.size(), 1U);
    EXPECT_EQ(parts.free[0].rows.size(), 3U);
    EXPECT_EQ(parts.free[0].cols.size(), 4U);
  }
}

TEST(ClosedParts, TellWhereFreedomsPassEnergyOn) {
  const auto passes_on = [](const Scene& scene) {
    return closed_parts(scene.model, initial_state(scene.model).q, 60).passes_on;
  };
  const auto shipped = [](const char* name) {
    return load_scene(std::string(MBS_ROOT "/harness/scenes/") + name);
  };
  using Each = std::vector<bool>;
  EXPECT_EQ(passes_on(shipped("double_pendulum.json")), Each(4, true));
  EXPECT_EQ(passes_on(shipped("pendulum.json")), Each(2, false));
  const Scene loop = crank_rocker();
  EXPECT_EQ(passes_on(loop), Each(static_cast<std::size_t>(loop.model.variables()), false));
  // Two rods below each other, which pass it on, beside two that a spring joins and one alone.
  const Scene three = scene_of(nlohmann::json::parse(R"({"points": [
      {"name": "A", "position": [0, 0], "fixed": true},
      {"name": "B", "position": [1, 0]}, {"name": "C", "position": [2, 0]},
      {"name": "D", "position": [3, 1]}, {"name": "E", "position": [3, 2]},
      {"name": "F", "position": [1, 1]}],
      "rods": [{"name": "upper", "between": ["A", "B"], "mass": 1},
               {"name": "lower", "between": ["B", "C"], "mass": 1},
               {"name": "left", "between": ["A", "D"], "mass": 1},
               {"name": "right", "between": ["A", "E"], "mass": 1},
               {"name": "alone", "between": ["A", "F"], "mass": 1}],
      "springs": [{"name": "spring", "between": ["D", "E"], "stiffness": 1, "length": 1}]})"),
                               "test");
  Each expected(8, true);
  expected.resize(10, false);
  EXPECT_EQ(passes_on(three), expected);
}

TEST(BranchWatch, FindsJumpsOfLoopsThatAreCarriedOrHaveSomethingHanging) {
  for (const Scene& scene : {crank_rocker(), carried_crank_rocker()}) {
    RunSettings settings;
    settings.step = chosen(scene.model, {.step = 1e-2, .scheme = Scheme::saddle_point});
    settings.duration = 3.2;
    const RunSummary summary = run(scene, test::reference(), settings);
    EXPECT_EQ(summary.status, RunStatus::wrong_branch) << summary.reason;
    EXPECT_NE(summary.reason.find("another assembly"), std::string::npos) << summary.reason;
  }
}

TEST(BranchWatch, DoesNotTakeTheOtherAssemblyForTheSameWhereTheyAreClose) {
  // A slider-crank, its rod 1e-7 m too long to pass upright.
  const Scene scene = scene_of(nlohmann::json::parse(R"({"gravity": [0, 0], "points": [
      {"name": "A", "position": [0, 0], "fixed": true},
      {"name": "D", "position": [0, 0.15], "fixed": true},
      {"name": "Dx", "position": [1, 0.15], "fixed": true},
      {"name": "B", "position": [0.2161209223472559, 0.33658839392315865]},
      {"name": "C", "position": [0.733503644568617, 0.15]}],
      "rods": [{"name": "crank", "between": ["A", "B"], "mass": 1, "length": 0.4},
               {"name": "rod", "between": ["B", "C"], "mass": 1, "length": 0.5500001}],
      "masses": [{"point": "C", "mass": 1}],
      "constraints": [{"name": "slides", "type": "on_line", "point": "C", "line": ["D", "Dx"]}]})"),
                               "test");
  ASSERT_EQ(closed_parts(scene.model, initial_state(scene.model).q, 60).free.size(), 1U);
  State state = initial_state(scene.model);
  const auto place = [&](double angle, double side) {
    const auto at = [side](double phi) {
      const double x = 0.4 * std::cos(phi), y = 0.4 * std::sin(phi);
      const double slid = std::sqrt(0.5500001 * 0.5500001 - (y - 0.15) * (y - 0.15));
      return std::vector<double>{x, y, x + side * slid, 0.15};
    };
    state.q = at(angle);
    const std::vector<double> next = at(angle + 1e-7);
    for (std::size_t i = 0; i < 4; ++i) state.v[i] = (next[i] - state.q[i]) / 1e-7;
    return state;
  };
  constexpr double kChange = -1.5707963267948966;
  for (const double side : {1.0, -1.0}) {
    BranchWatch watch(scene, place(kChange - 0.3, 1.0), judged_length(scene.model), true);
    EXPECT_EQ(watch.look(0.301, place(kChange + 1e-3, side)), "");
    const std::string found = watch.look(0.6, place(kChange + 0.3, side));
    EXPECT_EQ(found.empty(), side > 0.0) << found;
  }
}

TEST(BranchWatch, SeesASmallMechanismJumpBesideALargeOne) {
  // A rhombus of 1 mm, driven across its change point; a rod of 1 m swings by itself.
  const Scene scene = scene_of(nlohmann::json::parse(R"({"gravity": [0, 0], "points": [
      {"name": "A", "position": [0, 0], "fixed": true},
      {"name": "X", "position": [1, 0], "fixed": true},
      {"name": "D", "position": [9.9999e-4, 0], "fixed": true},
      {"name": "B", "position": [5.40302e-4, 8.41471e-4]},
      {"name": "C", "position": [1.540302e-3, 8.41471e-4]},
      {"name": "P", "position": [3, 0], "fixed": true},
      {"name": "Q", "position": [4, 0], "velocity": [0, 2]}],
      "rods": [{"name": "crank", "between": ["A", "B"], "mass": 1, "length": 1e-3},
               {"name": "coupler", "between": ["B", "C"], "mass": 1, "length": 1e-3},
               {"name": "rocker", "between": ["D", "C"], "mass": 1, "length": 1e-3},
               {"name": "rod", "between": ["P", "Q"], "mass": 1}],
      "constraints": [{"name": "drive", "type": "angle", "first": ["A", "X"],
                       "second": ["A", "B"], "value": {"polynomial": [1, 1]}}]})"),
                               "test");
  ASSERT_EQ(judged_length(scene.model), 1.0);
  RunSettings settings = test::automatic_settings(scene, 6.4);
  settings.step.scheme = Scheme::saddle_point;
  const RunSummary summary = run(scene, test::reference(), settings);
  EXPECT_EQ(summary.status, RunStatus::wrong_branch) << summary.reason;
  EXPECT_NE(summary.reason.find("rocker"), std::string::npos) << summary.reason;
}

}  // namespace
}  // namespace mbs
