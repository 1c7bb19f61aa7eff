// What bodies, joints, forces and drivers of a JSON scene become.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "model_math/jacobian_rank.hpp"
#include "model_math/kinematics.hpp"
#include "scene_file/load_scene.hpp"
#include "support/scene_support.hpp"

namespace mbs {
namespace {

SceneData data_of_text(const std::string& json) { return parse_scene(json, "test"); }

const Point& point_named(const ModelData& data, const std::string& name) {
  for (const Point& point : data.points) {
    if (point.name == name) return point;
  }
  throw std::runtime_error("no point " + name);
}

double mass_at(const ModelData& data, int row, int col) {
  for (const MassEntry& entry : data.mass) {
    if (entry.row == row && entry.col == col) return entry.value;
  }
  return 0.0;
}

/// Degrees of freedom by the rank of Phi_q, and rows that add nothing to it.
void expect_freedom(const std::string& json, int freedoms, int redundant, int variables) {
  const Model model(data_of_text(json).model);
  const int rank = jacobian_rank(model, model.initial_position()).value();
  EXPECT_EQ(model.variables(), variables) << json;
  EXPECT_EQ(model.variables() - rank, freedoms) << json;
  EXPECT_EQ(model.constraints() - rank, redundant) << json;
}

std::string planar(const std::string& rest) {
  return R"({"points": [{"name": "G", "position": [0, 0], "fixed": true},
    {"name": "A", "position": [1, 1]}, {"name": "B", "position": [3, 1]}], )" +
         rest + "}";
}

TEST(BodyScene, ThinRodAsBodyIsTheRod) {
  const std::string springs = R"("springs": [{"between": ["A", "G"]}, {"between": ["B", "G"]}])";
  const SceneData body =
      data_of_text(planar(R"("bodies": [{"name": "K", "mass": 6, "centre": [1, 0],
    "inertia": 2, "points": {"A": [0, 0], "B": [2, 0]}}], )" +
                          springs));
  const SceneData rod =
      data_of_text(planar(R"("rods": [{"between": ["A", "B"], "mass": 6}], )" + springs));
  ASSERT_EQ(body.model.mass.size(), rod.model.mass.size());  // nothing between x and y
  for (std::size_t i = 0; i < rod.model.mass.size(); ++i) {
    EXPECT_EQ(body.model.mass[i].row, rod.model.mass[i].row);
    EXPECT_EQ(body.model.mass[i].col, rod.model.mass[i].col);
    EXPECT_NEAR(body.model.mass[i].value, rod.model.mass[i].value, 1e-14);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(body.model.force[i], rod.model.force[i], 1e-13);
  }
  ASSERT_EQ(body.model.dot_constraints.size(), 1u);
  EXPECT_DOUBLE_EQ(body.model.dot_constraints[0].value, 4.0);
}

TEST(BodyScene, PointsOfOutputsAreMarkersAndCostNothing) {
  const SceneData data = data_of_text(planar(R"("rods": [{"between": ["G", "A"], "mass": 1}],
    "bodies": [{"name": "K", "mass": 1, "inertia": 1,
                "points": {"A": [0, 0], "B": [2, 0], "C": [1, 1], "D": [0, 1]}}],
    "springs": [{"between": ["B", "G"]}], "forces": [{"point": "C", "force": [1, 5]}],
    "outputs": [{"name": "c", "position": "C"}, {"name": "a", "angle": [["A", "C"], ["G", "A"]]}])"));
  EXPECT_EQ(data.model.points.size(), 3u);
  ASSERT_EQ(data.elements.markers.size(), 2u);
  const Marker& marker = data.elements.markers[0];
  EXPECT_EQ(marker.name, "C");
  EXPECT_EQ(data.elements.outputs[0].point, 3);
  EXPECT_EQ(data.elements.outputs[1].first.to, 3);
  EXPECT_EQ(data.elements.outputs[1].first.from, 1);
  double x = 0.0, y = 0.0;
  for (const Marker::Part& part : marker.parts) {
    const auto& r = data.model.points[static_cast<std::size_t>(part.point)].position;
    x += part.matrix[0][0] * r[0] + part.matrix[0][1] * r[1];
    y += part.matrix[1][0] * r[0] + part.matrix[1][1] * r[1];
  }
  EXPECT_NEAR(x, 2.0, 1e-14);
  EXPECT_NEAR(y, 2.0, 1e-14);
  // The force acts at C although C is no coordinate: its work in a turn about A is its moment.
  const double weight = -9.81;  // of the body, at A; B has none
  const auto& force = data.model.force;
  EXPECT_NEAR(force[2], 0.5 * 1 + 0.5 * 5, 1e-14);
  EXPECT_NEAR(force[3], 0.5 * 5 - 0.5 * 1, 1e-14);
  EXPECT_NEAR(force[0] + force[2], 1.0, 1e-14);
  EXPECT_NEAR(force[1] + force[3], 5.0 + weight - 0.5 * 9.81, 1e-13);
}

TEST(BodyScene, MassAtAMarkerJoinsTheBody) {
  const SceneData with_mass =
      data_of_text(planar(R"("bodies": [{"name": "K", "mass": 2, "inertia": 1,
    "points": {"A": [0, 0], "B": [2, 0], "C": [0, 1]}}], "masses": [{"point": "C", "mass": 3}],
    "springs": [{"between": ["B", "G"]}, {"between": ["A", "G"]}])"));
  const SceneData merged = data_of_text(planar(R"("bodies": [{"name": "K", "mass": 5,
    "centre": [0, 0.6], "inertia": 2.2, "points": {"A": [0, 0], "B": [2, 0]}}],
    "springs": [{"between": ["B", "G"]}, {"between": ["A", "G"]}])"));
  EXPECT_EQ(with_mass.model.points.size(), 3u);
  ASSERT_EQ(with_mass.model.mass.size(), merged.model.mass.size());
  for (std::size_t i = 0; i < merged.model.mass.size(); ++i) {
    EXPECT_NEAR(with_mass.model.mass[i].value, merged.model.mass[i].value, 1e-14);
  }
}

TEST(BodyScene, DrivenPointsLeaveTheirMassInQ) {
  // Everything falls with g, the driven points too: M a = Q without any constraint force.
  const SceneData planar_scene = data_of_text(R"({"points": [
    {"name": "A", "driven": {"x": 0, "y": {"polynomial": [0, 0, -4.905]}}},
    {"name": "B", "position": [1, 0]}, {"name": "C", "position": [2, 0]}],
    "bodies": [{"name": "K", "mass": 2, "centre": [0.5, 0.7], "inertia": 1,
                "points": {"A": [0, 0], "B": [1, 0]}}],
    "rods": [{"between": ["B", "C"], "mass": 1}]})");
  const SceneData rod = data_of_text(R"({"points": [
    {"name": "A", "driven": {"x": 0, "y": {"polynomial": [0, 0, -4.905]}}},
    {"name": "B", "position": [1, 0]}], "rods": [{"between": ["A", "B"], "mass": 1}]})");
  const SceneData spatial = data_of_text(R"({"dimension": 3, "points": [
    {"name": "A", "driven": {"x": 0, "y": {"polynomial": [0, 0, -4.905]}, "z": 0}}],
    "bodies": [{"name": "K", "mass": 2, "centre": [0.5, 0.7, 0.1], "inertia": [1, 1, 1.2],
                "points": {"A": [0, 0, 0]}, "pose": {}}]})");
  for (const SceneData* data : {&planar_scene, &rod, &spatial}) {
    const Model model(data->model);
    EXPECT_FALSE(model.driven_mass().empty());
    std::vector<double> a(static_cast<std::size_t>(model.variables()), 0.0), inertia(a), force(a);
    for (const Point& point : model.points()) {
      if (!point.is_fixed()) a[static_cast<std::size_t>(point.offset + 1)] = -9.81;
    }
    mass_times(model, a, inertia);
    applied_force(model, 0.3, model.initial_position(), model.initial_velocity(), force);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(inertia[i], force[i], 1e-13);
  }
}

TEST(BodyScene, PosesAndVelocitiesSpread) {
  // Only the first body says where it is and how it turns; its neighbour hangs on it.
  const SceneData data =
      data_of_text(R"({"points": [{"name": "O", "position": [1, 2], "fixed": true},
      {"name": "P", "position": [1, 3.5]}],
    "bodies": [{"name": "K", "mass": 1, "inertia": 1, "points": {"O": [0, 0], "E": [1, 0]},
                "pose": {"angle": 1.5707963267948966}, "angular_velocity": 2},
               {"name": "L", "mass": 1, "inertia": 1, "points": {"E": [0, 0], "P": [0.5, 0]}}],
    "springs": [{"between": ["P", "O"]}]})");
  const Point& E = point_named(data.model, "E");
  EXPECT_NEAR(E.position[0], 1.0, 1e-15);
  EXPECT_NEAR(E.position[1], 3.0, 1e-15);
  EXPECT_NEAR(data.model.initial_velocity[static_cast<std::size_t>(E.offset)], -2.0, 1e-12);
  // Free length left out: that of the assembled start.
  EXPECT_NEAR(data.model.springs[0].length, 1.5, 1e-12);
}

/// The place of E, of a body whose pose leaves out what its points show.
std::array<double, 3> place_of_E(const std::string& points, const std::string& pose) {
  const SceneData data = data_of_text(
      R"({"points": [{"name": "O", "position": [1, 2], "fixed": true},
      {"name": "G", "position": [3, 2], "fixed": true})" +
      points +
      R"(], "bodies": [{"name": "K", "mass": 1, "inertia": 1, "points": {"O": [0, 0], "B": [2, 0], "E": [1, 1]},
      "pose": )" +
      pose + R"(}], "springs": [{"between": ["B", "G"]}, {"between": ["E", "G"]}]})");
  return point_named(data.model, "E").position;
}

TEST(BodyScene, PosesTurnAsTheirPointsShow) {
  const auto expect_at = [](const std::array<double, 3>& place, double x, double y) {
    EXPECT_NEAR(place[0], x, 1e-12);
    EXPECT_NEAR(place[1], y, 1e-12);
  };
  const std::string up = R"(, {"name": "B", "position": [1, 4]})";
  for (const char* pose : {"{}", R"({"position": [1, 2]})", R"({"angle": 1.5707963267948966})"}) {
    expect_at(place_of_E(up, pose), 0.0, 3.0);
  }
  for (const char* pose : {"{}", R"({"position": [1, 2]})"})
    expect_at(place_of_E("", pose), 2.0, 3.0);
  EXPECT_THROW(place_of_E(up, R"({"angle": 0})"), UsageError);
  // The pose's position and one point.
  const SceneData data = data_of_text(R"({"points": [{"name": "B", "position": [1, 4]},
      {"name": "G", "position": [3, 2], "fixed": true}],
    "bodies": [{"name": "K", "mass": 1, "inertia": 1, "points": {"B": [2, 0], "E": [1, 1]}, "pose": {"position": [1, 2]}}],
    "springs": [{"between": ["B", "G"]}, {"between": ["E", "G"]}]})");
  expect_at(point_named(data.model, "E").position, 0.0, 3.0);
}

TEST(BodyScene, BodiesTurnAboutWhatIsHeldOrTheirCentre) {
  const auto speeds = [](const std::string& point) {
    return data_of_text(
               R"({"points": [{"name": "G", "position": [4, 0], "fixed": true}, {"name": "A", "position": [0, 0]})" +
               point +
               R"(], "bodies": [{"name": "K", "mass": 1, "inertia": 1, "centre": [1, 0], "points": {"A": [0, 0], "B": [3, 0]},
        "pose": {}, "angular_velocity": 2}], "springs": [{"between": ["A", "G"]}, {"between": ["B", "G"]}]})")
        .model.initial_velocity;
  };
  const auto expect = [](const std::vector<double>& v, const std::vector<double>& of_A_and_B) {
    ASSERT_EQ(v.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(v[i], of_A_and_B[i], 1e-12) << i;
  };
  expect(speeds(""), {0.0, -2.0, 0.0, 4.0});  // A has a place, but nothing holds it
  expect(speeds(R"(, {"name": "B", "velocity": [1, 0]})"), {1.0, -6.0, 1.0, 0.0});
}

TEST(BodyScene, FreedomsOfPlanarJoints) {
  // A body with three points at springs; the ground has G and X, and H where C is.
  const auto with = [](const std::string& constraint) {
    return R"({"points": [{"name": "G", "position": [0, 0], "fixed": true},
      {"name": "X", "position": [2, 2], "fixed": true}, {"name": "H", "position": [2, 2], "fixed": true},
      {"name": "A", "position": [1, 1]}, {"name": "B", "position": [3, 1]}],
      "bodies": [{"name": "K", "mass": 1, "inertia": 1,
                  "points": {"A": [0, 0], "B": [2, 0], "C": [1, 1]}}],
      "springs": [{"between": ["A", "G"]}, {"between": ["B", "X"]}, {"between": ["C", "H"]}],
      "constraints": [)" +
           constraint + "]}";
  };
  expect_freedom(with(""), 3, 0, 6);
  expect_freedom(with(R"({"type": "coincident", "points": ["C", "H"]})"), 1, 0, 6);
  expect_freedom(with(R"({"type": "on_line", "point": "C", "line": ["G", "X"]})"), 2, 0, 6);
  expect_freedom(with(R"({"type": "on_line", "point": "G", "line": ["A", "C"]})"), 2, 0, 6);
  expect_freedom(with(R"({"type": "angle", "first": ["G", "X"], "second": ["A", "B"]})"), 2, 0, 6);
  expect_freedom(with(R"({"type": "angle", "first": ["A", "B"], "second": ["G", "X"],
                         "value": {"polynomial": [0.8, 1]}})"),
                 2, 0, 6);
  expect_freedom(with(R"({"type": "perpendicular", "first": ["G", "X"], "second": ["C", "B"]})"), 2,
                 0, 6);
  expect_freedom(with(R"({"type": "distance", "between": ["G", "C"]})"), 2, 0, 6);
}

TEST(BodyScene, FreedomsOfSpatialJoints) {
  // Two boxes; what they share makes the joint. The first one is free.
  const auto pair = [](const std::string& more_first, const std::string& more_second,
                       const std::string& constraints) {
    return R"({"dimension": 3, "bodies": [
      {"name": "K", "mass": 1, "inertia": [1, 1.1, 1.2], "pose": {}, )" +
           more_first + R"(},
      {"name": "L", "mass": 1, "inertia": [1, 1.1, 1.2], "pose": {}, )" +
           more_second + R"(}],
      "constraints": [)" +
           constraints + "]}";
  };
  const std::string P = R"("points": {"P": [0, 0, 0]})";
  const std::string PQ = R"("points": {"P": [0, 0, 0], "Q": [0, 0, 1]})";
  const std::string u = R"("vectors": {"u": [0, 0, 1]})";
  const std::string uw = R"("vectors": {"u": [0, 0, 1], "w": [1, 0, 0]})";
  expect_freedom(pair(P, P, ""), 9, 0, 21);                        // spherical
  expect_freedom(pair(P + ", " + u, P + ", " + u, ""), 7, 0, 18);  // revolute
  expect_freedom(pair(PQ, PQ, ""), 7, 0, 18);                      // revolute
  expect_freedom(pair(R"("points": {}, "vectors": {"u": [0, 0, 1], "w": [1, 0, 0]})",
                      R"("points": {}, "vectors": {"u": [0, 0, 1], "w": [1, 0, 0]})", ""),
                 9, 0, 18);  // a sliding block without turning
  expect_freedom(
      pair(P + R"(, "vectors": {"u": [0, 0, 1]})", P + R"(, "vectors": {"w": [1, 0, 0]})",
           R"({"type": "perpendicular", "first": "u", "second": "w"})"),
      8, 0, 21);  // universal
  const std::string Q = R"("points": {"Q": [0, 0, 1]})";
  const std::string line = R"({"type": "on_line", "point": "Q", "line": "P", "direction": "u"})";
  expect_freedom(pair(P + ", " + u, Q + ", " + u, line), 8, 0, 21);  // cylindrical
  expect_freedom(pair(P + R"(, "vectors": {"u": [0, 0, 1], "k": [1, 0, 0]})",
                      Q + R"(, "vectors": {"u": [0, 0, 1], "l": [0, 1, 0]})",
                      line + R"(, {"type": "perpendicular", "first": "k", "second": "l"})"),
                 7, 0, 21);  // prismatic
}

TEST(BodyScene, FixedPointsAndVectorsAreConstants) {
  const auto door = [](const std::string& points, const std::string& vectors) {
    return R"({"dimension": 3, "points": [{"name": "A", "position": [0, 0, 0], "fixed": true},
      {"name": "B", "position": [0, 1, 0], "fixed": true}],
      "vectors": [{"name": "y", "direction": [0, 1, 0], "fixed": true},
                  {"name": "x", "direction": [1, 0, 0], "fixed": true}],
      "bodies": [{"name": "door", "mass": 2, "centre": [0.5, 0.5, 0], "inertia": [0.2, 0.1, 0.25],
                  "points": {)" +
           points + R"(}, "vectors": {)" + vectors + R"(}, "pose": {}}],
      "outputs": [{"name": "a", "position": "A"}, {"name": "b", "position": "B"},
                  {"name": "x", "position": "x"}, {"name": "y", "position": "y"}]})";
  };
  expect_freedom(door(R"("A": [0, 0, 0])", ""), 3, 0, 9);
  expect_freedom(door(R"("A": [0, 0, 0], "B": [0, 1, 0])", ""), 1, 0, 6);
  expect_freedom(door(R"("A": [0, 0, 0])", R"("y": [0, 1, 0])"), 1, 0, 6);
  expect_freedom(door(R"("A": [0, 0, 0], "B": [0, 1, 0])", R"("y": [0, 1, 0])"), 1, 0, 6);
  expect_freedom(door("", R"("y": [0, 1, 0])"), 4, 0, 9);
  expect_freedom(door("", R"("y": [0, 1, 0], "x": [1, 0, 0])"), 3, 0, 3);
}

TEST(BodyScene, EnergyOfBodiesOnFixedPoints) {
  const Scene plate = load_scene((kScenes / "examples/compound_pendulum.json").string());
  EXPECT_NEAR(kinetic_energy(plate.model, plate.model.initial_velocity()),
              0.5 * (0.05 + 2.0 * 0.17), 1e-13);
  const double height = 0.4 * std::sin(-0.5) + 0.1 * std::cos(-0.5);
  EXPECT_NEAR(potential_energy(plate.model, 0.0, plate.model.initial_position()),
              2.0 * 9.81 * height, 1e-12);
  // A bar about its fixed axis z, which is a vector of the body, 3 rad/s: J = 0.2 + 2 * 0.5^2.
  const Model bar(data_of_text(R"({"dimension": 3,
    "points": [{"name": "A", "position": [1, 1, 1], "fixed": true}],
    "vectors": [{"name": "z", "direction": [0, 0, 1], "fixed": true}],
    "bodies": [{"name": "bar", "mass": 2, "centre": [0.5, 0, 0.3], "inertia": [0.1, 0.2, 0.2],
                "points": {"A": [0, 0, 0]}, "vectors": {"z": [0, 0, 1]}, "pose": {},
                "angular_velocity": [0, 0, 3]}]})")
                      .model);
  EXPECT_NEAR(kinetic_energy(bar, bar.initial_velocity()), 0.5 * 0.7 * 9.0, 1e-13);
}

TEST(BodyScene, TorquesTurnBodies) {
  const SceneData plane = data_of_text(planar(R"("bodies": [{"name": "K", "mass": 1, "inertia": 1,
    "points": {"G": [0, 0], "A": [1.4142135623730951, 0]}}],
    "rods": [{"between": ["A", "B"], "mass": 1}], "torques": [{"body": "K", "torque": 3}])"));
  const Model model(plane.model);
  std::vector<double> force(4), still(4, 0.0);
  applied_force(model, 0.0, model.initial_position(), still, force);
  // Work in a turn about G by a small angle: r x f at A, from r = (1, 1).
  const double moment = (force[1] - model.force()[1]) - (force[0] - model.force()[0]);
  EXPECT_NEAR(moment, 3.0, 1e-13);

  const SceneData space = data_of_text(R"({"dimension": 3, "gravity": [0, 0, 0],
    "bodies": [{"name": "K", "mass": 1, "inertia": [1, 1, 1], "pose": {"rotation": [0.1, 0.2, 0.3]},
                "vectors": {"axis": [0, 0.6, 0.8]}}],
    "torques": [{"body": "K", "axis": "axis", "torque": 2}]})");
  const Model turned(space.model);
  std::vector<double> Q(static_cast<std::size_t>(turned.variables())), v(Q.size(), 0.0);
  applied_force(turned, 0.0, turned.initial_position(), v, Q);
  // Its power while the body turns about the axis at 1 rad/s is 2 W.
  const auto& axis = point_named(space.model, "axis").position;
  double power = 0.0;
  for (const Point& point : turned.points()) {
    if (point.is_fixed()) continue;
    const auto& r = point.position;
    const std::array<double, 3> rate{axis[1] * r[2] - axis[2] * r[1],
                                     axis[2] * r[0] - axis[0] * r[2],
                                     axis[0] * r[1] - axis[1] * r[0]};
    for (std::size_t i = 0; i < 3; ++i)
      power += rate[i] * Q[static_cast<std::size_t>(point.offset) + i];
  }
  EXPECT_NEAR(power, 2.0, 1e-12);
}

TEST(BodyScene, ConstraintForcesAreFoundByName) {
  const SceneData data =
      data_of_text(planar(R"("rods": [{"name": "r", "between": ["G", "A"], "mass": 1}],
    "bodies": [{"name": "K", "mass": 1, "inertia": 1, "points": {"A": [0, 0], "B": [2, 0]}},
               {"name": "L", "mass": 1, "inertia": 1, "points": {"B": [0, 0]}, "pose": {}}],
    "constraints": [
      {"name": "p", "type": "angle", "first": ["G", "A"], "second": ["A", "B"]},
      {"name": "l", "type": "linear", "terms": [{"point": "B", "axis": "x", "coefficient": 1}]}],
    "outputs": [{"name": "1", "constraint_force": "l"}, {"name": "2", "constraint_force": "p"},
                {"name": "3", "constraint_force": "r"}])"));
  EXPECT_EQ(data.model.dot_constraints.size(), 3u);
  const std::vector<Output>& outputs = data.elements.outputs;
  EXPECT_EQ(outputs[0].rows, std::vector<int>{4});
  EXPECT_EQ(outputs[1].rows, std::vector<int>{3});
  EXPECT_EQ(outputs[2].rows, (std::vector<int>{0, 3}));  // what the angle does along it
}

TEST(BodyScene, FurtherPointsKeepMPositiveDefinite) {
  const SceneData data = data_of_text(planar(R"("bodies": [{"name": "K", "mass": 1, "inertia": 1,
    "points": {"A": [0, 0], "B": [2, 0], "C": [1, 1]}}],
    "springs": [{"between": ["A", "G"]}, {"between": ["B", "G"]}, {"between": ["C", "G"]}])"));
  const int C = point_named(data.model, "C").offset;
  EXPECT_GT(mass_at(data.model, C, C), 0.0);
  EXPECT_EQ(mass_at(data.model, C + 1, C), 0.0);
  EXPECT_EQ(data.model.linear_constraints.size(), 2u);
}

TEST(BodyScene, ExamplesHaveNoRedundantRows) {
  for (const auto& entry : std::filesystem::directory_iterator(kScenes / "examples")) {
    if (entry.path().extension() != ".json") continue;
    const Scene scene = load_scene(entry.path().string());
    const int rank = jacobian_rank(scene.model, scene.model.initial_position()).value();
    // An angle that is driven between two moving directions has one row to spare.
    const int spare = entry.path().stem() == "driven_elbow" ? 1 : 0;
    EXPECT_EQ(scene.model.constraints() - rank, spare) << entry.path();
  }
}

/// A force that changes in time has a hidden point, which is fixed in the draft and lies anywhere.
TEST(BodyScene, VectorsBeginAtTheOriginWhateverPushes) {
  const auto of_force = [](const std::string& force) {
    return data_of_text(
        R"({"dimension": 3, "bodies": [{"name": "K", "mass": 1, "inertia": [1, 1, 1], "pose": {"position": [0, 0, 0]},
      "points": {"A": [0, 0, 0.1], "B": [1, 0, 0]}, "vectors": {"u": [0, 0, 1], "w": [0, 1, 0]}}],
      "vectors": [{"name": "g", "direction": [1, 0, 0], "fixed": true}],
      "constraints": [{"name": "c", "type": "perpendicular", "first": "w", "second": "g"},
        {"name": "d", "type": "perpendicular", "first": "u", "second": "g"}],
      "forces": [{"point": "A", "force": [0, )" +
        force + ", 0]}]}");
  };
  for (const char* force : {"5", R"({"polynomial": [5, 1]})"}) {
    const SceneData data = of_force(force);
    int edges = 0;
    for (const DotConstraint& dot : data.model.dot_constraints) {
      for (const auto& [to, from] : {std::pair{dot.a, dot.b}, std::pair{dot.c, dot.d}}) {
        const Point &tip = data.model.points[static_cast<std::size_t>(to)],
                    &foot = data.model.points[static_cast<std::size_t>(from)];
        if (!tip.is_vector) continue;
        ++edges;
        EXPECT_EQ(foot.position, (std::array{0.0, 0.0, 0.0})) << force;
      }
    }
    EXPECT_GT(edges, 0);
  }
}

}  // namespace
}  // namespace mbs
