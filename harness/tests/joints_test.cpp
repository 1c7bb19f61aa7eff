// Joints by name: the freedom that they leave, rows without surplus, what they refuse.
#include <gtest/gtest.h>

#include <string>

#include "model_math/jacobian_rank.hpp"
#include "scene_file/load_scene.hpp"
#include "support/scene_support.hpp"

namespace mbs {
namespace {

/// Freedoms and surplus rows at the start.
void expect_freedom(const Scene& scene, int freedoms) {
  const Model& model = scene.model;
  const int rank = jacobian_rank(model, model.initial_position()).value();
  EXPECT_EQ(model.variables() - rank, freedoms) << scene.name;
  EXPECT_EQ(model.constraints(), rank) << scene.name;
}

/// A free body K and a body L, by a joint with these members.
std::string two_bodies(const std::string& joint) {
  std::string vectors;  // those that the joint names: an unconnected one is refused
  if (joint.find("\"x\"") != std::string::npos) {
    vectors = R"({"name": "x", "direction": [1, 0, 0], "fixed": true})";
  }
  if (joint.find("\"z\"") != std::string::npos) {
    vectors += R"(, {"name": "z", "direction": [0, 0, 1], "fixed": true})";
  }
  return R"({"dimension": 3, "vectors": [)" + vectors + R"(], "points": [{"name": "O", "position": [0, 0, 0], "fixed": true}],
    "bodies": [{"name": "K", "mass": 1, "inertia": [1, 1, 1], "points": {"A": [0, 0, 0]},
       "vectors": {"u": [1, 0, 0], "n": [0, 0, 1]}, "pose": {"position": [0, 0, 0]}},
      {"name": "L", "mass": 1, "inertia": [1, 1, 1], "points": {"B": [0, 0, 0], "E": [0, 1, 0]},
       "vectors": {"w": [1, 0, 0], "m": [0, 1, 0]}, "pose": {"position": [1, 0, 0]}}],
    "springs": [{"between": ["O", "E"]}], "constraints": [{"name": "joint", )" +
         joint + "}]}";
}

Scene scene(const std::string& joint) {
  return scene_of(nlohmann::json::parse(two_bodies(joint)), joint);
}

TEST(Joints, LeaveTheirFreedom) {
  const std::string line = R"("point": "B", "line": "A", "direction": "u", "axis": "w")";
  expect_freedom(scene(R"("type": "cylindrical", )" + line), 12 - 4);
  expect_freedom(scene(R"("type": "prismatic", "across": ["n", "m"], )" + line), 12 - 5);
  expect_freedom(scene(R"("type": "prismatic", "across": ["n", ["B", "E"]], )" + line), 12 - 5);
}

TEST(Joints, OnTheGround) {
  const std::string line = R"("point": "B", "line": "O", "direction": "x", "axis": "w")";
  expect_freedom(scene(R"("type": "cylindrical", )" + line), 12 - 4);
  expect_freedom(scene(R"("type": "prismatic", "across": ["z", "m"], )" + line), 12 - 5);
  expect_freedom(scene(R"("type": "cylindrical", "point": "O", "line": "B", "direction": "w", "axis": "x")"),
                 12 - 4);
  const std::string far = R"({"dimension": 3, "points": [{"name": "O", "position": [0, 0, 0], "fixed": true}],
    "vectors": [{"name": "z", "direction": [0, 0, 1], "fixed": true}],
    "bodies": [{"name": "L", "mass": 1, "inertia": [1, 1, 1], "points": {"B": [0, 0, 0]},
       "vectors": {"w": [1, 0, 0]}, "pose": {"position": [0, 0, 0]}}], "constraints": [
    {"type": "universal", "points": ["B", "O"], "first": "z", "second": "w"}]})";
  expect_freedom(scene_of(nlohmann::json::parse(far), "universal"), 2);
}

TEST(Joints, UniversalTurnsAboutBothArms) {
  std::string text = two_bodies(R"("type": "universal", "points": ["A", "B"], "first": "n", "second": "w")");
  text.replace(text.find("\"position\": [1, 0, 0]"), 21, "\"position\": [0, 0, 0]");
  expect_freedom(scene_of(nlohmann::json::parse(text), "universal"), 12 - 4);
}

TEST(Joints, InThePlane) {
  const std::string before = R"({"points": [{"name": "O", "position": [0, 0], "fixed": true},
      {"name": "X", "position": [1, 0], "fixed": true}],
    "springs": [{"between": ["O", "Q"]}, {"between": ["X", "Q"]}],
    "bodies": [{"name": "K", "mass": 1, "inertia": 1, "points": {"A": [0, 0], "B": [1, 0]},
                "pose": {"position": [0, 0], "angle": 0.1}},
               {"name": "L", "mass": 1, "inertia": 1, "points": {"P": [0, 0], "Q": [0, 1]},
                "pose": {"position": [0.5, 0]}}],
    "constraints": [{"type": "prismatic", "point": "P", "line": )";
  for (const char* line : {R"(["A", "B"])", R"(["O", "X"])"}) {
    const std::string text = before + line + R"(, "axis": ["P", "Q"]}]})";
    expect_freedom(scene_of(nlohmann::json::parse(text), line), 6 - 2);
  }
}

TEST(Joints, TheExampleHasAFreedomAJoint) {
  const Scene joints = load_scene((kScenes / "examples/joints.json").string());
  expect_freedom(joints, 1 + 1 + 2 + 2);  // base, ram, collar, shaft
}

TEST(Joints, RefuseWhatIsNone) {
  const std::string line = R"("point": "B", "line": "A", "direction": "u")";
  const struct {
    std::string joint;
    std::vector<std::string> parts;
  } cases[] = {
      {R"("type": "cylindrical", )" + line, {"constraints[0]", "no key \"axis\""}},
      {R"("type": "cylindrical", "axis": "n", )" + line, {"one body only (\"K\")"}},
      {R"("type": "cylindrical", "axis": "B", )" + line, {"the point \"B\"", "a unit vector"}},
      {R"("type": "prismatic", "axis": "w", )" + line, {"no key \"across\""}},
      {R"("type": "prismatic", "axis": "w", "across": ["n"], )" + line, {"across", "two directions"}},
      {R"("type": "prismatic", "axis": "w", "across": ["n", "w"], )" + line,
       {"across", "do not tell a turn"}},
      {R"("type": "universal", "points": ["A", "B"], "first": "n", "second": "u")",
       {"one body only (\"K\")"}},
      {R"("type": "prismatc", )" + line, {"the nearest is \"prismatic\""}},
  };
  for (const auto& [joint, parts] : cases) expect_parts(parse_error_of(two_bodies(joint)), parts);
  for (const char* type : {"cylindrical", "universal"}) {
    std::string text = R"({"points": [{"name": "A", "position": [0, 0]}], "constraints": [{"type": ")";
    expect_parts(parse_error_of(text + type + "\"}]}"), {"constraints[0].type: ", "in the plane"});
  }
}

}  // namespace
}  // namespace mbs
