// Numbers of a scene as expressions of its parameters.
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "scene_file/load_scene.hpp"
#include "support/folder.hpp"
#include "support/scene_support.hpp"
#include "sweep/sweep_grid.hpp"

namespace mbs {
namespace {

/// A pendulum whose mass and parameters are these.
std::string scene(const std::string& parameters, const std::string& mass) {
  return R"({"parameters": )" + parameters + R"(, "points": [
    {"name": "A", "position": [0, 0], "fixed": true}, {"name": "B", "position": [0, "=-l"]}],
    "rods": [{"between": ["A", "B"], "mass": 0}], "masses": [{"point": "B", "mass": )" +
         mass + "}]}";
}

TEST(Parameters, StandWhereverANumberStands) {
  const struct {
    const char *parameters, *mass;
    double expected;
  } cases[] = {
      {R"({"l": 2, "m": 3})", R"("=2*m")", 6.0},
      {R"({"l": 2, "m": 2e-3})", R"("=m")", 2e-3},
      {R"({"l": 2, "m": "=3*l^2"})", R"("=m + 1")", 13.0},
      {R"({"l": "=z/2", "m": "=l", "z": 5})", R"("=m")", 2.5},  // in any order
      {R"({"l": 1})", R"x("=pi * sqrt(4)")x", 2 * std::numbers::pi},
      {R"({"l": -1})", R"("=l < 0 ? 7 : 8")", 7.0},
  };
  for (const auto& [parameters, mass, expected] : cases) {
    const SceneData data = parse_scene(scene(parameters, mass), "test");
    EXPECT_DOUBLE_EQ(data.model.mass[0].value, expected) << mass;
  }
  EXPECT_DOUBLE_EQ(parse_scene(scene(R"({"l": 2})", "1"), "test").model.points[1].position[1], -2.0);
}

TEST(Parameters, NeedNoParameters) {
  EXPECT_DOUBLE_EQ(parse_scene(pendulum("3}", "\"=6/2\"}"), "test").model.mass[0].value, 1.0);
}

TEST(Parameters, ComplaintsNameThePlace) {
  const struct {
    const char *parameters, *mass;
    std::vector<std::string> parts;
  } cases[] = {
      {R"({"l": 1, "k": 1})", R"("=2*q+k")",
       {"test.json: masses[0].mass: ", R"(the unknown name "q" in "=2*q+k")", "pi, k, l"}},
      {R"({"l": "=m", "m": "=2*l"})", "1", {"parameters.", "depends on itself"}},
      {R"({"l": "=l"})", "1", {"parameters.l: ", "depends on itself"}},
      {R"({"l": 1})", R"("=1/0")", {"masses[0].mass: ", "which is inf"}},
      {R"({"l": 1})", R"x("=sqrt(-1)")x", {"masses[0].mass: ", "nan"}},
      {R"({"l": 1})", R"("=2*(l")", {"masses[0].mass: ", R"("=2*(l")"}},
      {R"({"l": 1})", R"("=")", {"masses[0].mass: "}},
      {R"({"l": 1})", R"("=l, 2")", {"masses[0].mass: ", "one expression"}},
      {R"({"l": 1})", R"("=l=2")", {"masses[0].mass: "}},
      {R"({"l": 1})", R"("=-l")", {"masses[0].mass: ", "found -1"}},
      {R"({"l": 1, "k": 2})", "1", {"parameters.k: ", "nothing uses"}},
      {R"({"l": 1, "2k": 2})", "1", {"parameters.2k: ", "no digit in front"}},
      {R"({"l": 1, "sin": 2})", "1", {"parameters.sin: ", "function"}},
      {R"({"l": 1, "pi": 3})", "1", {"parameters.pi: "}},
      {R"({"l": true})", "1", {"parameters.l: found true", "a number or an expression"}},
      {R"([1])", "1", {"parameters: ", "an object"}},
      {R"({"l": 1})", R"("l")", {"masses[0].mass: found \"l\", allowed is a number"}},
  };
  for (const auto& [parameters, mass, parts] : cases) {
    expect_parts(parse_error_of(scene(parameters, mass)), parts);
  }
}

TEST(Parameters, AreVariedByName) {
  const std::string path = (kScenes / "examples/parameters.json").string();
  const SweepGrid grid(path, {"k=100,400", "masses/B/mass=1,2"});
  EXPECT_EQ(grid.lanes(), 4);
  const Scene first = grid.scene(0), last = grid.scene(3);
  EXPECT_DOUBLE_EQ(last.model.springs()[0].stiffness / first.model.springs()[0].stiffness, 4.0);
  EXPECT_DOUBLE_EQ(last.model.data().mass[0].value, 2.0 * first.model.data().mass[0].value);
}

TEST(Parameters, ANumberMayTakeThePlaceOfTheOnlyExpressionThatNamesOne) {
  const test::Folder folder;
  const std::string path = folder.file("scene.json");
  std::ofstream(path) << scene(R"({"l": 2, "m": 3})", R"("=m")");
  const SweepGrid grid(path, {"masses/B/mass=4,5"});
  EXPECT_DOUBLE_EQ(grid.scene(1).model.data().mass[0].value, 5.0);
}

}  // namespace
}  // namespace mbs
