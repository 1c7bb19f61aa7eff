// Forces, torques and energies of driven scenes against closed forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "controls/controls.hpp"
#include "run/initial_state.hpp"
#include "run/output_values.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"
#include "support/scene_support.hpp"

namespace mbs {
namespace {

/// The outputs of a scene at its start, from accelerations and multipliers that are consistent.
std::vector<double> outputs_at_start(const std::string& json) {
  SceneData data = parse_scene(json, "test");
  const Scene scene{"test", Model(data.model), {}, {}, data.elements, data.assembly};
  const State state = initial_state(scene.model);
  OutputValues values(scene);
  values.follow(0.0, state);
  return values.values();
}

constexpr double kAngle = 0.7, kSpin = 1.1, kTurn = 2.3;  // rad, 1/s, 1/s^2: theta'' = kTurn
constexpr double kTorque = 3.0 * kTurn * 4.0;             // 3 kg at 2 m, without gravity

/// 3 kg at 2 m from A, turned by `constraint`; gravity -9.81 along y.
std::string motor(const std::string& constraint) {
  return fmt::format(R"({{"points": [{{"name": "A", "position": [0, 0], "fixed": true}},
      {{"name": "X", "position": [1, 0], "fixed": true}},
      {{"name": "B", "position": [{}, {}], "velocity": [{}, {}]}}],
    "rods": [{{"between": ["A", "B"], "mass": 0}}], "masses": [{{"point": "B", "mass": 3}}],
    "constraints": [{{"name": "motor", "type": "angle", {}}}],
    "outputs": [{{"name": "M", "constraint_force": "motor"}}]}})",
                     2 * std::cos(kAngle), 2 * std::sin(kAngle), -2 * kSpin * std::sin(kAngle),
                     2 * kSpin * std::cos(kAngle), constraint);
}

std::string angle_function(double sign) {
  return fmt::format(R"({{"polynomial": [{}, {}, {}]}})", sign * kAngle, sign * kSpin,
                     sign * kTurn / 2);
}

TEST(ConstraintForce, OfADrivenAngleIsTheMotorsTorque) {
  const double weight = 3 * 9.81 * 2 * std::cos(kAngle);
  const auto forward = outputs_at_start(
      motor(R"("first": ["A", "X"], "second": ["A", "B"], "value": )" + angle_function(1)));
  EXPECT_NEAR(forward[0], kTorque + weight, 1e-9);
  const auto backward = outputs_at_start(
      motor(R"("first": ["A", "B"], "second": ["A", "X"], "value": )" + angle_function(-1)));
  EXPECT_NEAR(backward[0], -(kTorque + weight), 1e-9);
}

TEST(ConstraintForce, OfAConstantAngleHoldsTheWeight) {
  const auto values = outputs_at_start(R"({"gravity": [0, -10], "points": [
      {"name": "A", "position": [0, 0], "fixed": true}, {"name": "X", "position": [1, 0], "fixed": true},
      {"name": "B", "position": [0.6, 0.8]}, {"name": "falls", "position": [5, 0]}],
    "rods": [{"between": ["A", "B"], "mass": 0}],
    "masses": [{"point": "B", "mass": 3}, {"point": "falls", "mass": 1}],
    "constraints": [{"name": "hold", "type": "angle", "first": ["A", "X"], "second": ["A", "B"]}],
    "outputs": [{"name": "M", "constraint_force": "hold"}]})");
  EXPECT_NEAR(values[0], 3 * 10 * 0.6, 1e-9);
}

TEST(ConstraintForce, OfAnAngleBetweenMovingLinksIsTheMotorsTorqueToo) {
  // Without gravity and with the first link at rest, driven faster at its end: m l^2 (its own
  // acceleration), on 1 kg at 1 m; the first link's rods are so heavy that they stay.
  const auto values = outputs_at_start(R"({"gravity": [0, 0], "points": [
      {"name": "A", "position": [0, 0], "fixed": true}, {"name": "B", "position": [1, 0]},
      {"name": "C", "position": [1.6, 0.8]}],
    "rods": [{"between": ["A", "B"], "mass": 0}, {"between": ["B", "C"], "mass": 0}],
    "masses": [{"point": "B", "mass": 1e9}, {"point": "C", "mass": 1}],
    "constraints": [{"name": "elbow", "type": "angle", "first": ["A", "B"], "second": ["B", "C"],
                     "value": {"polynomial": [0.9272952180016122, 0, 1.5]}}],
    "outputs": [{"name": "M", "constraint_force": "elbow"}]})");
  EXPECT_NEAR(values[0], 3.0, 1e-6);
}

/// A and B on massless rods, held at 60 degrees by `angle`, turn about O as one at 2 rad/s.
std::string triangle(bool is_spatial, const std::string& angle) {
  const auto at = [&](const std::string& plane) {
    return '[' + plane + (is_spatial ? ", 0]" : "]");
  };
  const auto rail = [](const std::string& point) {
    return R"(, {"type": "linear", "terms": [{"point": ")" + point +
           R"(", "axis": "z", "coefficient": 1}], "value": 0})";
  };
  return std::string(is_spatial ? R"({"dimension": 3, )" : "{") +
         R"("points": [{"name": "O", "fixed": true, "position": )" + at("0, 0") +
         R"(}, {"name": "A", "position": )" + at("1, 0") + R"(, "velocity": )" + at("0, 2") +
         R"(}, {"name": "B", "position": )" + at("1.5, 0.8660254037844386") + R"(}],
    "rods": [{"name": "OA", "between": ["A", "O"], "mass": 0}, {"name": "AB", "between": ["A", "B"], "mass": 0}],
    "masses": [{"point": "A", "mass": 1}, {"point": "B", "mass": 2}],
    "constraints": [{"type": "angle", "first": ["O", "A"], "second": ["A", "B"], "value": )" +
         angle + "}" + (is_spatial ? rail("A") + rail("B") : "") + R"(],
    "outputs": [{"name": "1", "constraint_force": "OA"}, {"name": "2", "constraint_force": "AB"}]})";
}

// An angle's row pulls along its directions too, unless it is a right angle.
TEST(ConstraintForce, OfARodIsItsWholePullBesideAnAngle) {
  const double cosine = 0.5, sine = std::sqrt(0.75), spin = 2.0;
  const double x = 1 + cosine, faster = -9.81 * (1 + 2 * x) / (1 + 2 * (x * x + sine * sine));
  const double at_a = -spin * spin;  // along x; gravity is not
  const double at_b_x = -faster * sine - spin * spin * x;
  const double at_b_y = faster * x - spin * spin * sine + 9.81;
  const double first = -(at_a + 2 * at_b_x), second = -2 * (cosine * at_b_x + sine * at_b_y);
  for (const bool is_spatial : {false, true}) {
    for (const std::string angle :
         {"1.0471975511965976", R"({"polynomial": [1.0471975511965976, 1e-9]})"}) {
      SCOPED_TRACE(angle);
      const std::string text = triangle(is_spatial, angle);
      const auto values = outputs_at_start(text);
      EXPECT_NEAR(values[0], first, 1e-6);
      EXPECT_NEAR(values[1], second, 1e-6);
      const Scene scene = scene_of(nlohmann::json::parse(text), "test");
      std::vector<std::vector<double>> ends;
      for (const Scheme scheme : {Scheme::penalty, Scheme::saddle_point}) {
        RunSettings settings;
        settings.step = chosen(scene.model, {.step = 1e-3, .scheme = scheme});
        settings.duration = 0.5;
        OutputValues outputs(scene);
        run(scene, test::reference(), settings, [&](long /*step*/, double t, const State& state) {
          outputs.follow(t, state);
          if (t > 0.4999) ends.push_back(outputs.values());
        });
      }
      ASSERT_EQ(ends.size(), 2u);
      for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(ends[0][i], ends[1][i], 1e-4) << i;
    }
  }
}

TEST(ConstraintForce, OfARodIsItsWholePullBesideAnAngleToAFixedDirection) {
  // 1 kg goes round at 3 rad/s on a cone of 60 degrees.
  const auto values = outputs_at_start(R"({"dimension": 3, "gravity": [0, 0, -10], "points": [
      {"name": "O", "position": [0, 0, 0], "fixed": true},
      {"name": "B", "position": [0.8660254037844386, 0, 0.5], "velocity": [0, 2.598076211353316, 0]}],
    "vectors": [{"name": "z", "direction": [0, 0, 1], "fixed": true}],
    "rods": [{"name": "rod", "between": ["O", "B"], "mass": 0}], "masses": [{"point": "B", "mass": 1}],
    "constraints": [{"name": "cone", "type": "angle", "first": "z", "second": ["O", "B"]}],
    "outputs": [{"name": "T", "constraint_force": "rod"}]})");
  EXPECT_NEAR(values[0], 0.75 * 9 - 0.5 * 10, 1e-9);
}

TEST(ConstraintForce, OfAPerpendicularInSpaceIsATorqueAboutBoth) {
  // A weight of 2 kg, 3 m along x from a fixed point, held across the fixed z.
  const auto values = outputs_at_start(R"({"dimension": 3, "gravity": [0, 0, -10], "points": [
      {"name": "O", "position": [0, 0, 0], "fixed": true}, {"name": "P", "position": [3, 0, 0]}],
    "vectors": [{"name": "z", "direction": [0, 0, 1], "fixed": true}],
    "rods": [{"between": ["O", "P"], "mass": 0}], "masses": [{"point": "P", "mass": 2}],
    "constraints": [{"name": "level", "type": "perpendicular", "first": "z", "second": ["O", "P"]}],
    "outputs": [{"name": "M", "constraint_force": "level"}]})");
  EXPECT_NEAR(values[0], -60.0, 1e-9);  // z x x = y: against the turn that would lower P
}

TEST(ConstraintForce, OfJointsIsTheForceOnTheirPoint) {
  // 2 kg on a slope of 3 : 4, and 5 kg on a peg.
  const auto values = outputs_at_start(R"({"gravity": [0, -10], "points": [
      {"name": "A", "position": [0, 0], "fixed": true}, {"name": "E", "position": [4, 3], "fixed": true},
      {"name": "P", "position": [2, 1.5]}, {"name": "R", "position": [7, 7]},
      {"name": "S", "position": [7, 7], "fixed": true}],
    "masses": [{"point": "P", "mass": 2}, {"point": "R", "mass": 5}],
    "constraints": [{"name": "slope", "type": "on_line", "point": "P", "line": ["A", "E"]},
                    {"name": "peg", "type": "coincident", "points": ["R", "S"]}],
    "outputs": [{"name": "n", "constraint_force": "slope"}, {"name": "f", "constraint_force": "peg"}]})");
  ASSERT_EQ(values.size(), 4u);
  EXPECT_NEAR(values[0], -20 * 0.8 * 0.6, 1e-9);
  EXPECT_NEAR(values[1], 20 * 0.8 * 0.8, 1e-9);
  EXPECT_NEAR(values[2], 0.0, 1e-9);
  EXPECT_NEAR(values[3], 50.0, 1e-9);
}

TEST(ConstraintForce, OnAMovingLineIsTheForceOnThePoint) {
  // The line's far end carries so much that it stays.
  const auto values = outputs_at_start(R"({"gravity": [0, -10], "points": [
      {"name": "A", "position": [0, 0], "fixed": true}, {"name": "E", "position": [4, 3]},
      {"name": "P", "position": [2, 1.5]}, {"name": "S", "position": [4, 9], "fixed": true}],
    "rods": [{"between": ["A", "E"], "mass": 0}, {"between": ["E", "S"], "mass": 0}],
    "masses": [{"point": "P", "mass": 2}, {"point": "E", "mass": 1}],
    "constraints": [{"name": "slope", "type": "on_line", "point": "P", "line": ["A", "E"]}],
    "outputs": [{"name": "n", "constraint_force": "slope"}]})");
  EXPECT_NEAR(values[0], -20 * 0.8 * 0.6, 1e-9);
  EXPECT_NEAR(values[1], 20 * 0.8 * 0.8, 1e-9);
}

TEST(ConstraintForce, OfALinearConstraintIsTheMultiplierOfPhiAsGiven) {
  const auto values = outputs_at_start(R"({"gravity": [0, -10],
    "points": [{"name": "P", "position": [2, 0]}], "masses": [{"point": "P", "mass": 2}],
    "constraints": [{"name": "floor", "type": "linear",
                     "terms": [{"point": "P", "axis": "y", "coefficient": 4}]}],
    "outputs": [{"name": "f", "constraint_force": "floor"}]})");
  EXPECT_NEAR(values[0], -5.0, 1e-9);  // -4 lambda = 20 N
}

TEST(Energy, IncludesWhatDrivenPointsCarry) {
  // A rod of 2 kg hangs from a point that moves at (1, 0.5) m/s; its centre is 0.5 m below.
  const std::string rod = R"({"points": [
      {"name": "D", "position": [0, 3],
       "driven": {"x": {"polynomial": [0, 1]}, "y": {"polynomial": [3, 0.5]}}},
      {"name": "B", "position": [0, 2], "velocity": [1, 0.5]}],
    "rods": [{"between": ["D", "B"], "mass": 2}],
    "outputs": [{"name": "k", "energy": "kinetic"}, {"name": "p", "energy": "potential"},
                {"name": "e", "energy": "total"}]})";
  const auto values = outputs_at_start(rod);
  EXPECT_NEAR(values[0], 1.25, 1e-12);
  EXPECT_NEAR(values[1], 2 * 9.81 * 2.5, 1e-12);
  EXPECT_NEAR(values[2], 1.25 + 2 * 9.81 * 2.5, 1e-12);
}

TEST(Energy, IncludesSpringsWhoseStiffnessIsAFunctionOfTime) {
  for (const char* length : {R"(, "length": 0.8)", ""}) {
    for (const char* stiffness : {"100", R"({"polynomial": [100, 1e-9]})"}) {
      const auto values = outputs_at_start(
          R"({"points": [{"name": "O", "position": [0, 0], "fixed": true},
        {"name": "B", "position": [1, 0]}], "masses": [{"point": "B", "mass": 1}],
      "springs": [{"between": ["O", "B"], "damping": 3, "stiffness": )" +
          std::string(stiffness) + length +
          R"(}], "outputs": [{"name": "V", "energy": "potential"}]})");
      EXPECT_NEAR(values[0], *length == '\0' ? 0.0 : 2.0, 1e-12) << stiffness << length;
    }
  }
}

TEST(Energy, OfABodyBetweenDrivenPointsIsWhole) {
  // 3 kg, 0.4 kg m^2 about its centre at (1, 1), with two points driven apart from each other's
  // way as turning at 2 rad/s about the first does, and one free.
  const auto values = outputs_at_start(R"({"gravity": [0, 0], "points": [
      {"name": "D", "position": [0, 0],
       "driven": {"x": {"polynomial": [0, 1]}, "y": 0}}, {"name": "B", "position": [2, 0]}],
    "bodies": [{"name": "K", "mass": 3, "inertia": 0.4, "centre": [1, 1],
                "points": {"D": [0, 0], "B": [2, 0]}, "angular_velocity": 2}],
    "outputs": [{"name": "k", "energy": "kinetic"}]})");
  // centre: (1, 0) + 2 (-1, 1) = (-1, 2)
  EXPECT_NEAR(values[0], 0.5 * 3 * 5 + 0.5 * 0.4 * 4, 1e-12);
}

}  // namespace
}  // namespace mbs
