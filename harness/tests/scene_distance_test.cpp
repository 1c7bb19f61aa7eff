// What errors are measured by: points of bodies that are no coordinates, and unit vectors, count.
#include "run/scene_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "controls/controls.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/run_settings.hpp"

namespace mbs {
namespace {

/// Two bodies on one ball joint that share three unit vectors, the only coordinates; the tip of the
/// first is u + v/10.
Scene on_vectors() {
  SceneData data = parse_scene(R"({
    "dimension": 3,
    "points": [{"name": "O", "position": [0, 0, 0], "fixed": true}],
    "bodies": [
      {"name": "a", "mass": 2, "centre": [0.5, 0, 0], "inertia": [0.02, 0.05, 0.06],
       "points": {"O": [0, 0, 0], "tip": [1, 0.1, 0]},
       "vectors": {"u": [1, 0, 0], "v": [0, 1, 0], "w": [0, 0, 1]},
       "pose": {"position": [0, 0, 0], "rotation": [0, 0.3, 0.2]}, "angular_velocity": [0, 3, 1]},
      {"name": "b", "mass": 1, "centre": [0, 0.5, 0], "inertia": [0.02, 0.05, 0.06],
       "points": {"O": [0, 0, 0]},
       "vectors": {"u": [1, 0, 0], "v": [0, 1, 0], "w": [0, 0, 1]},
       "pose": {"position": [0, 0, 0], "rotation": [0, 0.3, 0.2]}, "angular_velocity": [0, 3, 1]}
    ]})",
                               "test");
  return {"test", Model(std::move(data.model)), {}, {}, std::move(data.elements), data.assembly};
}

std::size_t offset_of(const Scene& scene, const char* name) {
  const auto points = scene.model.points();
  const auto found = std::ranges::find(points, name, &Point::name);
  return static_cast<std::size_t>(found->offset);
}

double farthest_apart(const Scene& scene, double length, const std::vector<double>& x,
                      const std::vector<double>& y) {
  double result = 0.0;
  for_each_point(
      scene, length,
      [&result](const Vector3& off) {
        const double distance = std::sqrt(dot(off, off));
        if (!(distance <= result)) result = distance;
      },
      [&](std::size_t i) { return x[i] - y[i]; });
  return result;
}

TEST(SceneDistance, CountsPointsOfBodiesAndUnitVectors) {
  const Scene scene = on_vectors();
  const std::vector<double> x(static_cast<std::size_t>(scene.model.variables()), 0.5);
  std::vector<double> y = x;
  EXPECT_EQ(farthest_apart(scene, 1.0, x, y), 0.0);
  y[offset_of(scene, "v") + 2] += 0.25;
  EXPECT_NEAR(farthest_apart(scene, 0.0, x, y), 0.025, 1e-15);  // of the tip
  EXPECT_NEAR(farthest_apart(scene, 2.0, x, y), 0.5, 1e-15);    // of v, as if 2 m long
  y[offset_of(scene, "u")] += 3.0;
  EXPECT_NEAR(farthest_apart(scene, 0.0, x, y), std::hypot(3.0, 0.025), 1e-14);
}

RunSummary run_with_half_step(const Scene& scene, double step, double duration, double tolerance) {
  RunSettings settings;
  settings.duration = duration;
  settings.step.step = step;
  settings.step.penalty = automatic_penalty(scene.model, settings.step);
  settings.step.tolerance = tolerance;
  return run(scene, test::reference(), test::with_half_step(scene, settings));
}

TEST(HalfStep, SeesBodiesWithoutFreePoints) {
  const RunSummary summary = run_with_half_step(on_vectors(), 1e-2, 3.3, 1e-10);
  EXPECT_EQ(summary.status, RunStatus::degraded);
  EXPECT_GT(summary.position_error_estimate.value(), 0.1);  // m; 0.26 to 0.29 against fine steps
  EXPECT_GT(summary.local_error_sum.value(), 3e-3);
}

/// A pointer of 0.1 m on a torsion spring of 1 Hz, at rest in the middle of a turning rod of 20 m.
Scene pointer_on_rod() {
  return scene_of(nlohmann::json::parse(R"({"gravity": [0, 0], "points": [
      {"name": "O", "position": [0, 0], "fixed": true}, {"name": "P", "position": [0.1, 0]},
      {"name": "E", "position": [10, 0], "velocity": [0, 5]},
      {"name": "F", "position": [-10, 0], "velocity": [0, -5]}],
      "rods": [{"name": "rod", "between": ["E", "F"], "mass": 1000},
               {"name": "pointer", "between": ["O", "P"], "mass": 1}],
      "constraints": [
          {"type": "linear", "terms": [{"point": "E", "axis": "x", "coefficient": 1},
                                       {"point": "F", "axis": "x", "coefficient": 1}]},
          {"type": "linear", "terms": [{"point": "E", "axis": "y", "coefficient": 1},
                                       {"point": "F", "axis": "y", "coefficient": 1}]}],
      "torsion_springs": [{"from": ["O", "E"], "to": ["O", "P"], "stiffness": 0.1315947}]})"),
                  "test");
}

TEST(SceneDistance, AShortLinkIsMeasuredByItself) {
  // Off by 2.7 % of the pointer after 40 s, and by little of the rod.
  const Scene scene = pointer_on_rod();
  ASSERT_GT(judged_length(scene.model), 1.0);
  RunSettings settings = test::automatic_settings(scene, 40.0);
  settings.step = chosen(scene.model, {.step = 0.02});
  const RunSummary coarse = run(scene, test::reference(), settings);
  EXPECT_EQ(coarse.status, RunStatus::degraded);
  EXPECT_NE(coarse.reason.find("\"pointer\""), std::string::npos) << coarse.reason;
  const RunSummary halved = run_with_half_step(scene, 0.02, 40.0, 1e-10);
  EXPECT_NE(halved.reason.find("of a length at most"), std::string::npos) << halved.reason;
  const RunSummary fine = run_with_half_step(scene, 2.5e-3, 40.0, 1e-10);
  EXPECT_EQ(fine.status, RunStatus::ok) << fine.reason;
}

TEST(HalfStep, LeavesLocalErrorsToCountToo) {
  // Both steps are wrong in part alike.
  const Scene scene = load_scene(MBS_ROOT "/harness/scenes/four_bar_2.json");
  const RunSummary summary = run_with_half_step(scene, 0.01, 3.3, 1e-7);
  EXPECT_LT(summary.position_error_estimate.value(), 1e-2);
  EXPECT_EQ(summary.status, RunStatus::degraded);
  EXPECT_NE(summary.reason.find("local errors add up to"), std::string::npos) << summary.reason;
}

}  // namespace
}  // namespace mbs
