// What a run's drivers allow: their ranges during the whole of it, and steps that resolve them.
#include "run/driver_end.hpp"

#include <gtest/gtest.h>

#include <string>

#include "run/stretch.hpp"
#include "scene_file/load_scene.hpp"
#include "support/scene_support.hpp"

namespace mbs {
namespace {

std::string refusal(const std::string& json, double step, long steps) {
  SceneData data = parse_scene(json, "test.json");
  const Scene scene{"test.json", Model(std::move(data.model)), {}, {}, std::move(data.elements)};
  try {
    require_drivers(scene, step, steps);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "none";
}

std::string lift(const std::string& value) {
  return R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
    {"name": "B", "position": [0, -1]}], "masses": [{"point": "B", "mass": 1}],
    "constraints": [{"name": "lift", "type": "distance", "between": ["A", "B"], "value": )" +
         value + "}]}";
}

std::string elbow(const std::string& value) {
  return R"({"dimension": 3, "points": [{"name": "A", "position": [0, 0, 0], "fixed": true}],
    "vectors": [{"name": "z", "direction": [0, 0, 1], "fixed": true}],
    "bodies": [{"name": "arm", "mass": 1, "inertia": [1, 1, 1], "points": {"A": [0, 0, 0]},
      "vectors": {"u": [1, 0, 0]}, "pose": {"rotation": [0, -0.3707963267948966, 0]}}],
    "assembly": {"largest_correction": 10},
    "constraints": [{"type": "angle", "first": "z", "second": "u", "value": )" +
         value + "}]}";
}

TEST(RequireDrivers, DistancesStayAboveZero) {
  const std::string json = lift(R"({"polynomial": [1, 0, -0.5]})");
  EXPECT_EQ(refusal(json, 0.01, 141), "none");
  expect_parts(refusal(json, 0.01, 200),
               {"test.json: constraints[0].value: found a value of constraints[0] \"lift\"",
                "at t = 1.42 s, allowed is a distance in m above 0 until the end", "2 s"});
}

TEST(RequireDrivers, SpatialAnglesStayInTheirRange) {
  const std::string json = elbow(R"({"polynomial": [1.2, 1]})");
  EXPECT_EQ(refusal(json, 0.01, 193), "none");
  expect_parts(refusal(json, 0.01, 1000), {"constraints[0].value: found a value", "at t = 1.94 s",
                                           "allowed is 0.01 to pi - 0.01 rad"});
}

TEST(RequireDrivers, StepsResolveThem) {
  const auto wave = [](double frequency) {
    return lift(R"({"sine": {"amplitude": 0.1, "offset": 1, "frequency": )" +
                std::to_string(frequency) + "}}");
  };
  EXPECT_EQ(refusal(wave(40), 1.25e-3, 10), "none");
  for (const double frequency : {41.0, 100.0, 800.0}) {
    expect_parts(refusal(wave(frequency), 1.25e-3, 10),
                 {"constraints[0].value: found a driver", "too fast for --step 0.00125 s",
                  "1/20 of the sine's period"});
  }
  expect_parts(refusal(wave(100), 1.25e-3, 10), {"allowed is up to 0.0005 s"});
  const std::string table = lift(R"({"table": {"times": [0, 0.1, 0.2, 0.25, 0.3],
                                               "values": [1, 1.1, 1.2, 1.25, 1.3]}})");
  EXPECT_EQ(refusal(table, 0.05, 6), "none");
  expect_parts(refusal(table, 0.06, 5), {"allowed is up to 0.05 s, the table's shortest row"});
  expect_parts(refusal(table, 0.05, 7), {"ends at 0.3 s"});
  const std::string turn = R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
    {"name": "X", "position": [1, 0], "fixed": true}, {"name": "B", "position": [0, 1]}],
    "rods": [{"between": ["A", "B"], "mass": 1}],
    "constraints": [{"type": "angle", "first": ["A", "X"], "second": ["A", "B"],
                     "value": {"polynomial": [1.5707963267948966, 100]}}]})";
  EXPECT_EQ(refusal(turn, 3e-3, 10), "none");
  expect_parts(refusal(turn, 4e-3, 10), {"changes by 0.4 rad in the step", "0.3142 rad a step"});
}

TEST(RequireDrivers, StretchesAreHeldToThem) {
  SceneData data = parse_scene(lift(R"({"polynomial": [1, 0, -0.5]})"), "test.json");
  const Scene scene{"test.json", Model(std::move(data.model)), {}, {}, std::move(data.elements)};
  EXPECT_NO_THROW(make_stretch(scene, 0.01, 100));
  EXPECT_THROW(make_stretch(scene, 0.01, 200), UsageError);
}

}  // namespace
}  // namespace mbs
