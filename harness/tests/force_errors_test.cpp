// Forces and accelerations that a scene asks for, against closed forms, and what becomes of a run
// where they are off.
#include "run/force_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "registry/registry.hpp"
#include "run/initial_state.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

RunSummary judged_forces(const Scene& scene, StepSettings step, double duration,
                         const Observer& observer = {}) {
  const NamedVariant variant = select_variants({"eigen_dense/llt"}).front();  // in double precision
  RunSettings settings;
  settings.step = chosen(scene.model, step);
  settings.duration = duration;
  return run(scene, *variant.variant, settings, observer);
}

constexpr double kCrankLength = 0.1, kRodLength = 0.3, kPistonMass = 2.0,
                 kCrankSpeed = 10.0;  // m, m, kg, rad/s

Scene driven_crank() {
  return scene_of(nlohmann::json::parse(R"({"gravity": [0, 0],
    "points": [{"name": "O", "position": [0, 0], "fixed": true}, {"name": "X", "position": [1, 0], "fixed": true},
               {"name": "E", "position": [0.1, 0], "velocity": [0, 1]}, {"name": "P", "position": [0.4, 0]}],
    "rods": [{"between": ["O", "E"], "mass": 0}, {"between": ["E", "P"], "mass": 0}],
    "masses": [{"point": "E", "mass": 1}, {"point": "P", "mass": 2}],
    "constraints": [{"type": "on_line", "point": "P", "line": ["O", "X"]},
                    {"name": "motor", "type": "angle", "first": ["O", "X"], "second": ["O", "E"],
                     "value": {"polynomial": [0, 10]}}],
    "outputs": [{"name": "torque", "constraint_force": "motor"}, {"name": "piston", "acceleration": "P"}]})"),
                  "test");
}

/// What the motor has to do, N m: its power is that of the piston.
double motor_torque(double t) {
  const double angle = kCrankSpeed * t, s = std::sin(angle), c = std::cos(angle);
  const double root = std::sqrt(kRodLength * kRodLength - kCrankLength * kCrankLength * s * s);
  const double first = -kCrankLength * s - kCrankLength * kCrankLength * s * c / root;  // dx/dangle
  const double second = -kCrankLength * c - kCrankLength * kCrankLength * (c * c - s * s) / root -
                        std::pow(kCrankLength, 4) * s * s * c * c / std::pow(root, 3);
  return kPistonMass * first * second * kCrankSpeed * kCrankSpeed;
}

TEST(ForceErrors, DegradeARunByAClosedForm) {
  const Scene scene = driven_crank();
  const auto off = [&](StepSettings step, RunStatus expected) {
    double error = 0.0, largest = 0.0;
    OutputValues outputs(scene);
    const RunSummary summary =
        judged_forces(scene, step, 3.0, [&](long /*step*/, double t, const State& state) {
          outputs.follow(t, state);
          error = std::max(error, std::abs(outputs.values()[0] - motor_torque(t)));
          largest = std::max(largest, std::abs(motor_torque(t)));
        });
    EXPECT_EQ(summary.status, expected) << summary.reason;
    EXPECT_EQ(summary.forces_lost.empty(), expected == RunStatus::plausible);
    return error / largest;
  };
  for (const Scheme scheme : {Scheme::penalty, Scheme::saddle_point}) {
    for (const Projections projections : {Projections::both, Projections::velocity}) {
      StepSettings step{.step = 4e-3, .projections = projections, .scheme = scheme};
      EXPECT_LT(off(step, RunStatus::plausible), 0.05);
      step.step = 2e-2;
      EXPECT_GT(off(step, RunStatus::degraded), 0.05);
    }
    EXPECT_GT(off({.step = 4e-3, .projections = Projections::none, .scheme = scheme},
                  RunStatus::degraded),
              0.05);
  }
}

TEST(ForceErrors, SayWhichAndByWhenAndWhatHelps) {
  StepSettings step{.step = 5e-3};
  step.projections = Projections::none;
  const RunSummary summary = judged_forces(driven_crank(), step, 3.0);
  EXPECT_TRUE(summary.forces_lost.starts_with("output \"")) << summary.forces_lost;
  EXPECT_NE(summary.forces_lost.find("--projections both"), std::string::npos);
  EXPECT_TRUE(summary.failed_at);
}

Scene rod_at_rest(const char* gravity) {
  return scene_of(nlohmann::json::parse(R"({"gravity": [0, )" + std::string(gravity) + R"(],
    "points": [{"name": "A", "position": [0, 0], "fixed": true}, {"name": "B", "position": [1, 0]}],
    "rods": [{"name": "rod", "between": ["A", "B"], "mass": 1}],
    "outputs": [{"name": "pull", "constraint_force": "rod"}]})"),
                  "test");
}

TEST(ForceErrors, ShowTheRoundingOfThePenaltyForm) {
  const auto drowns = [&](double penalty, Scheme scheme) {
    return !judged_forces(rod_at_rest("-9.81"),
                          {.penalty = penalty, .tolerance = 1e-9, .scheme = scheme}, 0.1)
                .forces_lost.empty();
  };
  EXPECT_FALSE(drowns(1e9, Scheme::penalty));
  EXPECT_TRUE(drowns(1e17, Scheme::penalty));
  EXPECT_FALSE(drowns(1e17, Scheme::saddle_point));
}

TEST(ForceErrors, AreNoneWhereNothingActsOrAForceIsNextToNothing) {
  const Scene scene = rod_at_rest("0");
  ForceErrors errors(scene);
  State state = initial_state(scene.model);
  errors.compare(0.0, state);
  EXPECT_EQ(errors.beyond(), "");
  const Scene falling = rod_at_rest("-9.81");  // level and at rest: the rod pulls nothing
  ForceErrors small(falling);
  state = initial_state(falling.model);
  state.lambda[0] += 1e-5;
  small.compare(0.0, state);
  EXPECT_EQ(small.beyond(), "");
  state.lambda[0] += 1.0;
  small.compare(0.0, state);
  EXPECT_NE(small.beyond(), "");
}

// A square with both diagonals: what one rod more pulls, others push.
TEST(ForceErrors, LeaveOpenWhatConstraintsLeaveOpen) {
  const Scene scene = scene_of(
      nlohmann::json::parse(R"({"points": [{"name": "O", "position": [0, 0], "fixed": true},
      {"name": "A", "position": [1, 0]}, {"name": "B", "position": [1, 1]}, {"name": "C", "position": [0, 1]}],
    "rods": [{"name": "OA", "between": ["O", "A"], "mass": 1}, {"name": "AB", "between": ["A", "B"], "mass": 1},
      {"name": "BC", "between": ["B", "C"], "mass": 1}, {"name": "CO", "between": ["C", "O"], "mass": 1},
      {"name": "OB", "between": ["O", "B"], "mass": 1}, {"name": "AC", "between": ["A", "C"], "mass": 1}],
    "outputs": [{"name": "pull", "constraint_force": "OA"}]})"),
      "test");
  ForceErrors errors(scene);
  State state = initial_state(scene.model);
  const double stress[] = {1, 1, 1, 1, -1, -1};  // per length squared: the same force densities
  for (std::size_t k = 0; k < 6; ++k) state.lambda[k] += 100 * stress[k];
  errors.compare(0.0, state);
  EXPECT_EQ(errors.beyond(), "");
}

}  // namespace
}  // namespace mbs
