// Paths, ranges, the grid, and lanes that have the outcome of a run alone.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "controls/batches.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/folder.hpp"
#include "support/scene_support.hpp"
#include "sweep/lane.hpp"
#include "sweep/scene_number.hpp"
#include "sweep/sweep_grid.hpp"
#include "sweep/value_range.hpp"

namespace mbs {
namespace {

using nlohmann::json;

std::string usage_error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

const json kDocument = json::parse(R"({
  "gravity": [0, -9.81],
  "points": [{"name": "A.1", "position": [0, 1]}, {"name": "a/b~", "position": [2, 3]},
             {"name": "0", "position": [4, 5]}],
  "rods": [{"between": ["A.1", "0"], "mass": 6}],
  "masses": [{"point": "0", "mass": 7}, {"point": "0", "mass": 8}, {"point": "A.1", "mass": 9}],
  "springs": []
})");

TEST(SceneNumber, IsFoundByNameOrIndex) {
  const struct {
    const char* path;
    double value;
  } cases[] = {{"gravity/1", -9.81},
               {"points/A.1/position/1", 1.0},
               {"points/a~1b~0/position/0", 2.0},
               {"points/0/position/0", 4.0},  // the name wins
               {"points/1/position/1", 3.0},
               {"rods/A.1-0/mass", 6.0},
               {"masses/A.1/mass", 9.0},
               {"masses/1/mass", 8.0}};
  for (const auto& [path, value] : cases) {
    EXPECT_EQ(kDocument.at(find_number(kDocument, path)), value) << path;
  }
}

TEST(SceneNumber, SaysWhatThereIs) {
  const struct {
    const char* path;
    std::vector<std::string> parts;
  } cases[] = {
      {"mases/0/mass", {R"(no "mases" in the scene)", "one of gravity, masses, points"}},
      {"points/C/position/0", {R"(no "C" in points)", "A.1, a/b~, 0, or an index from 0 to 2"}},
      {"gravity/2", {R"(no "2" in gravity)", "an index from 0 to 1"}},
      {"gravity/-1", {R"(no "-1" in gravity)"}},
      {"gravity", {"found an array of 2", "a number: go on with an index from 0 to 1"}},
      {"masses/A.1", {"found an object", "a number: go on with one of mass, point"}},
      {"masses/A.1/point", {R"(found the text "A.1")", "allowed is a number"}},
      {"masses/0/mass", {R"("0" twice, as items 0 and 1)", "or an index"}},
      {"masses/A.1/mass/0", {"9 in masses/2/mass, and nothing below it"}},
      {"springs/s", {R"(no "s" in springs)", "nothing: it is empty"}},
      {"rods/1/mass", {"A.1-0, or the index 0"}},
      {"", {R"(no "" in the scene)"}},
  };
  for (const auto& [path, parts] : cases) {
    const std::string error = usage_error_of([&path = path] { find_number(kDocument, path); });
    expect_parts(error, {"--vary \"" + std::string(path) + "\": "});
    expect_parts(error, parts);
  }
}

TEST(ValueRange, IsSpacedAsAsked) {
  EXPECT_EQ(parse_range("1:3:3", "p"), (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(parse_range("3:-1:2", "p"), (std::vector<double>{3.0, -1.0}));
  EXPECT_EQ(parse_range("5,-2,1e-3", "p"), (std::vector<double>{5.0, -2.0, 1e-3}));
  EXPECT_EQ(parse_range("7", "p"), (std::vector<double>{7.0}));
  const std::vector<double> tenths = parse_range("0.1:0.7:7", "p");
  EXPECT_EQ(tenths.front(), 0.1);
  EXPECT_EQ(tenths.back(), 0.7);
  const std::vector<double> decades = parse_range("-1e-3:-1e3:7:log", "p");
  ASSERT_EQ(decades.size(), 7U);
  for (int i = 0; i < 7; ++i) {
    const double expected = -std::pow(10.0, i - 3);
    EXPECT_NEAR(decades[static_cast<std::size_t>(i)], expected, 1e-14 * std::abs(expected));
  }
  EXPECT_EQ(decades.back(), -1e3);
  EXPECT_NEAR(parse_range("1e-200:1e-180:3:log", "p")[1] / 1e-190, 1.0, 1e-12);  // their product is 0
  EXPECT_NEAR(parse_range("1e-200:1e200:3:log", "p")[1], 1.0, 1e-12);            // their ratio is infinite
}

TEST(ValueRange, RefusesWhatIsNone) {
  for (const char* text :
       {"", "a", "1:2", "1:2:3:4", "1:2:3:LOG", "1:2:1", "1:2:2.5", "1:2:1000001", "0:1:3:log",
        "-1:1:3:log", "1,,2", "1,2,", "1:x:3", "nan", "inf", "+1", "1e999", " 1", "1;2"}) {
    const std::string error = usage_error_of([text] { parse_range(text, "gravity/1"); });
    expect_parts(error, {"--vary \"gravity/1\": found ", ", allowed is "});
  }
}

std::string pendulum_path() { return (kScenes / "point_mass_pendulum.json").string(); }

TEST(SweepGrid, VariesTheLastFastest) {
  const SweepGrid grid("four-bar:1", {"gravity/1=-2,-1", "rods/A0-B0/mass=1:3:3"});
  EXPECT_EQ(grid.lanes(), 6);
  EXPECT_EQ(grid.values(0), (std::vector<double>{-2.0, 1.0}));
  EXPECT_EQ(grid.values(1), (std::vector<double>{-2.0, 2.0}));
  EXPECT_EQ(grid.values(5), (std::vector<double>{-1.0, 3.0}));
  EXPECT_EQ(grid.scene(5).model.force()[1], -2.0);  // B0 carries half of 3 kg and half of 1 kg
  EXPECT_EQ(grid.describe(1), "lane 2 of 6 (gravity/1 = -2, rods/A0-B0/mass = 2)");
}

TEST(SweepGrid, RefusesWhatCannotBeVaried) {
  const auto error = [](const std::string& scene, const std::vector<std::string>& vary) {
    return usage_error_of([&] { SweepGrid(scene, vary); });
  };
  expect_parts(error("four-bar:1", {"gravity/1"}), {"\"gravity/1\"", "PATH=RANGE"});
  expect_parts(error("four-bar:1", {"=1"}), {"PATH=RANGE"});
  expect_parts(error("four-bar:1", {"points/B0/velocity/0=1,2", "points/2/velocity/0=1,2"}),
               {"the same number as --vary \"points/B0/velocity/0\""});
  expect_parts(error("four-bar:1", {"gravity/1=1:2:1001", "gravity/0=1:2:1000"}),
               {"--vary \"gravity/0\"", "more than 1000000 lanes"});
  expect_parts(error("four-bar:1,fill=0.9", {"gravity/1=1"}), {"fill"});
  expect_parts(error("four-bar:0", {"gravity/1=1"}), {"allowed is a whole number"});
  expect_parts(error("nowhere.json", {"gravity/1=1"}), {"no such file"});
}

TEST(SweepGrid, RefusesAParameterThatAnotherAxisLeavesUnused) {
  const test::Folder folder;
  const std::string scene = folder.file("scene.json");
  std::ofstream(scene) << R"({"parameters": {"m": 2, "k": "=3*m", "v": 1}, "points": [
    {"name": "A", "position": [0, 0], "fixed": true},
    {"name": "B", "position": [0, -2], "velocity": ["=v", 0]}],
    "rods": [{"between": ["A", "B"], "mass": 1}], "masses": [{"point": "B", "mass": "=k"}]})";
  const auto error = [&](const std::vector<std::string>& vary) {
    return usage_error_of([&] { SweepGrid(scene, vary); });
  };
  const std::vector<std::vector<std::string>> unused{
      {"m=1,2", "k=5"}, {"k=5", "v=1", "m=uniform:1:2"}, {"masses/B/mass=1", "m=1"}};
  for (const std::vector<std::string>& vary : unused) {
    expect_parts(error(vary), {"--vary \"m\": found a parameter that nothing uses where --vary \"",
                               "puts numbers"});
  }
  expect_parts(error({"m=1", "k=1", "masses/B/mass=1"}),
               {R"(--vary "k": found a parameter that nothing uses where --vary "masses/B/mass")"});
  EXPECT_EQ(error({"m=1,2", "v=1,2"}), "no error");
  EXPECT_EQ(error({"k=1,2", "v=1,2"}), "no error");  // m may be left unused: it is not varied
}

TEST(SweepGrid, KnowsTheFourBar) {
  for (const int loops : {1, 4}) {
    const Scene made = load_scene("four-bar:" + std::to_string(loops));
    const Scene read = scene_of(four_bar_document(loops), "four-bar");
    EXPECT_TRUE(have_same_shape(made.model, read.model));
    EXPECT_FALSE(read.four_bar_loops);
    const ModelData &x = made.model.data(), &y = read.model.data();
    EXPECT_EQ(x.force, y.force);
    EXPECT_EQ(x.initial_velocity, y.initial_velocity);
    for (std::size_t i = 0; i < x.mass.size(); ++i) EXPECT_EQ(x.mass[i].value, y.mass[i].value);
    for (std::size_t i = 0; i < x.points.size(); ++i) {
      EXPECT_EQ(x.points[i].name, y.points[i].name);
      EXPECT_EQ(x.points[i].position, y.points[i].position);
    }
    for (std::size_t i = 0; i < x.dot_constraints.size(); ++i) {
      EXPECT_EQ(x.dot_constraints[i].value, y.dot_constraints[i].value);
    }
    ASSERT_EQ(read.elements.outputs.size(), 2U);
    EXPECT_EQ(read.elements.outputs[1].name, "vB0");
  }
}

/// Six pendulums under six gravities, that of lane 1 among them.
std::vector<Lane> six_lanes() {
  const SweepGrid grid("four-bar:1", {"gravity/1=-12:-2:6"});
  std::vector<Lane> lanes;
  for (long i = 0; i < grid.lanes(); ++i) {
    Lane lane{grid.scene(i), {}};
    lane.settings.duration = 0.25;
    lane.settings.step = chosen(lane.scene.model);
    lanes.push_back(std::move(lane));
  }
  return lanes;
}

Variant batch_variant(const std::string& name) {
  for (Variant& variant : test::batches()) {
    if (variant.name == name) return variant;
  }
  throw std::invalid_argument("no batch is called " + name);
}

/// The six lanes by `name`, four at once and then two.
std::vector<Lane> run_six(const std::string& name) {
  std::vector<Lane> lanes = six_lanes();
  const Variant variant = batch_variant(name);
  EXPECT_EQ(lanes_at_once(variant), 4U);
  run_lanes(std::span(lanes).first(4), variant);
  run_lanes(std::span(lanes).subspan(4), variant);
  return lanes;
}

void expect_same(const Lane& actual, const Lane& expected) {
  EXPECT_EQ(actual.summary.status, expected.summary.status);
  EXPECT_EQ(actual.summary.reason, expected.summary.reason);
  EXPECT_EQ(actual.summary.steps, expected.summary.steps);
  EXPECT_EQ(actual.summary.passes, expected.summary.passes);
  EXPECT_EQ(actual.summary.local_error_sum, expected.summary.local_error_sum);
  EXPECT_EQ(actual.summary.energy_drift_max, expected.summary.energy_drift_max);
  EXPECT_EQ(actual.summary.constraint_violation_max, expected.summary.constraint_violation_max);
  ASSERT_EQ(actual.outputs.size(), expected.outputs.size());
  for (std::size_t i = 0; i < actual.outputs.size(); ++i) {
    EXPECT_EQ(actual.outputs[i].last, expected.outputs[i].last);
    EXPECT_EQ(actual.outputs[i].least, expected.outputs[i].least);
    EXPECT_EQ(actual.outputs[i].most, expected.outputs[i].most);
  }
}

/// Each lane by run() alone.
const std::vector<Lane>& alone() {
  static const std::vector<Lane> result = [] {
    std::vector<Lane> lanes = six_lanes();
    Variant variant = batch_variant("sound");
    variant.create_batch = nullptr;
    EXPECT_EQ(lanes_at_once(variant), 1U);
    for (Lane& lane : lanes) run_lanes(std::span(&lane, 1), variant);
    return lanes;
  }();
  return result;
}

TEST(SweepLanes, AloneAreWhatRunSays) {
  const std::vector<Lane>& lanes = alone();
  for (const Lane& lane : lanes) {
    const RunSummary expected = run(lane.scene, batch_variant("sound"), lane.settings);
    EXPECT_EQ(lane.summary.status, RunStatus::plausible) << lane.summary.reason;
    EXPECT_EQ(lane.summary.passes, expected.passes);
    EXPECT_EQ(lane.summary.local_error_sum, expected.local_error_sum);
    ASSERT_EQ(lane.outputs.size(), 4U);     // B0.x, B0.y, vB0.x, vB0.y
    EXPECT_EQ(lane.outputs[0].least, 0.0);  // the start, from where it moves to the right
    EXPECT_EQ(lane.outputs[0].most, lane.outputs[0].last);
    EXPECT_GT(lane.outputs[0].last, 0.2);
  }
  EXPECT_NE(lanes[0].outputs[2].last, lanes[5].outputs[2].last);
}

TEST(SweepLanes, InABatchAreAsAlone) {
  const long before = test::batch_steps();
  const std::vector<Lane> lanes = run_six("sound");
  EXPECT_EQ(test::batch_steps() - before, 6 * 200);
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    SCOPED_TRACE(i);
    expect_same(lanes[i], alone()[i]);
  }
}

TEST(SweepLanes, ALostLaneDoesNotDisturb) {
  const long before = test::batch_steps();
  const std::vector<Lane> lanes = run_six("lost_lane");
  EXPECT_LT(test::batch_steps() - before, 6 * 200 - 200);  // retired: lanes 1 and 5
  for (const std::size_t i : {0U, 2U, 3U, 4U}) {
    SCOPED_TRACE(i);
    expect_same(lanes[i], alone()[i]);
  }
  for (const std::size_t i : {1U, 5U}) {
    EXPECT_EQ(lanes[i].summary.status, RunStatus::diverged);
    EXPECT_EQ(lanes[i].summary.reason, "the state is not finite");
    ASSERT_TRUE(lanes[i].summary.failed_at);
    // Alone the lane is sound, so that the first lost step is the one that was judged.
    EXPECT_GE(*lanes[i].summary.failed_at, 40 * 1.25e-3);
    EXPECT_LE(*lanes[i].summary.failed_at, (40 + 64) * 1.25e-3);
    EXPECT_TRUE(lanes[i].outputs.empty());
  }
}

TEST(SweepLanes, AFailedFactorizationIsOfItsLane) {
  const std::vector<Lane> lanes = run_six("failed_lane");
  expect_same(lanes[0], alone()[0]);
  expect_same(lanes[3], alone()[3]);
  EXPECT_EQ(lanes[1].summary.status, RunStatus::diverged);
  EXPECT_EQ(lanes[1].summary.reason, "the tangent matrix could not be factorized");
  EXPECT_EQ(lanes[1].summary.steps, 40);
  EXPECT_NEAR(lanes[1].summary.failed_at.value(), 40 * 1.25e-3, 1e-15);
}

TEST(SweepLanes, WhereABatchCannotBeLanesRunAlone) {
  for (const char* name : {"throws", "unsupported"}) {
    const std::vector<Lane> lanes = [name] {
      std::vector<Lane> all = six_lanes();
      run_lanes(all, batch_variant(name));
      return all;
    }();
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(i));
      expect_same(lanes[i], alone()[i]);
    }
  }
}

TEST(SweepLanes, ABatchTakesOneShape) {
  std::vector<Lane> lanes = six_lanes();
  EXPECT_TRUE(fit_one_batch(lanes[0], lanes[1]));
  lanes[1].settings.duration *= 2;
  EXPECT_FALSE(fit_one_batch(lanes[0], lanes[1]));
  lanes[2].settings.step.scheme = Scheme::saddle_point;
  EXPECT_FALSE(fit_one_batch(lanes[0], lanes[2]));
  lanes[3].scene = load_scene(pendulum_path());
  EXPECT_FALSE(fit_one_batch(lanes[0], lanes[3]));
}

TEST(SweepLanes, TheHalfStepRunsBesideALane) {
  std::vector<Lane> lanes = six_lanes();
  for (Lane& lane : lanes) {
    StepSettings half = lane.settings.step;
    half.step /= 2;
    half.penalty *= 4;
    lane.settings.half_step = half;
  }
  run_lanes(lanes, batch_variant("sound"));
  for (const Lane& lane : lanes) {
    EXPECT_EQ(lane.summary.status, RunStatus::ok) << lane.summary.reason;
    EXPECT_GT(lane.summary.position_error_estimate.value(), 0.0);
    EXPECT_GT(lane.summary.local_error_sum.value(), 0.0);
  }
}

}  // namespace
}  // namespace mbs
