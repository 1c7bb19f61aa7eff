// Scenes that load: the generated mechanism, files, the members of the JSON format.
#include "scene/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "model_math/kinematics.hpp"
#include "scene_file/load_scene.hpp"
#include "support/scene_support.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

double mass_at(const Model& model, int row, int col) {
  for (const MassEntry& entry : model.mass()) {
    if (entry.row == row && entry.col == col) return entry.value;
  }
  return 0.0;
}

void expect_same_model(const Model& x, const Model& y) {
  ASSERT_EQ(x.points().size(), y.points().size());
  for (std::size_t i = 0; i < x.points().size(); ++i) {
    EXPECT_EQ(x.points()[i].name, y.points()[i].name);
    EXPECT_EQ(x.points()[i].offset, y.points()[i].offset);
    EXPECT_EQ(x.points()[i].position, y.points()[i].position);
  }
  ASSERT_EQ(x.constraints(), y.constraints());
  for (std::size_t i = 0; i < x.dot_constraints().size(); ++i) {
    const DotConstraint& a = x.dot_constraints()[i];
    const DotConstraint& b = y.dot_constraints()[i];
    EXPECT_TRUE(a.a == b.a && a.b == b.b && a.c == b.c && a.d == b.d && a.value == b.value) << i;
  }
  ASSERT_EQ(x.mass().size(), y.mass().size());
  for (std::size_t i = 0; i < x.mass().size(); ++i) {
    EXPECT_EQ(x.mass()[i].row, y.mass()[i].row);
    EXPECT_EQ(x.mass()[i].col, y.mass()[i].col);
    EXPECT_EQ(x.mass()[i].value, y.mass()[i].value);
  }
  for (int i = 0; i < x.variables(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_EQ(x.force()[k], y.force()[k]);
    EXPECT_EQ(x.initial_velocity()[k], y.initial_velocity()[k]);
  }
}

TEST(FourBar, IsTheMechanismOfThePaper) {
  const Model model(four_bar(3));
  EXPECT_EQ(model.variables(), 8);
  EXPECT_EQ(model.constraints(), 7);
  EXPECT_EQ(mass_at(model, 0, 0), 2.0 / 3.0);  // a crank and a coupler
  EXPECT_EQ(mass_at(model, 2, 2), 1.0);        // a crank and two couplers
  EXPECT_EQ(mass_at(model, 7, 7), 2.0 / 3.0);
  EXPECT_EQ(mass_at(model, 3, 1), 1.0 / 6.0);
  EXPECT_EQ(mass_at(model, 2, 1), 0.0);
  EXPECT_EQ(model.force()[0], 0.0);
  EXPECT_DOUBLE_EQ(model.force()[1], -9.81);
  EXPECT_DOUBLE_EQ(model.force()[3], -1.5 * 9.81);
  std::vector<double> residual(7);
  evaluate_constraints(model, 0.0, model.initial_position(), residual);
  for (const double value : residual) EXPECT_EQ(value, 0.0);
  constraint_rate(model, 0.0, model.initial_position(), model.initial_velocity(), residual);
  for (const double value : residual) EXPECT_EQ(value, 0.0);
}

TEST(FourBar, EnergyIsThatOfTheReducedMechanism) {
  // Eq. (9): all cranks turn at 1 rad/s, all couplers move at 1 m/s; heights 1/2 and 1.
  for (const int loops : {1, 4}) {
    const Model model(four_bar(loops));
    const double cranks = loops + 1;
    EXPECT_NEAR(kinetic_energy(model, model.initial_velocity()) +
                    potential_energy(model, 0.0, model.initial_position()),
                cranks / 6.0 + loops / 2.0 + 9.81 * (cranks / 2.0 + loops), 1e-12);
  }
}

TEST(FourBar, LoadsByName) {
  const Scene scene = load_scene("four-bar:40");
  EXPECT_EQ(scene.name, "four-bar:40");
  EXPECT_EQ(scene.four_bar_loops, 40);
  EXPECT_FALSE(scene.fill.has_value());
  EXPECT_EQ(scene.model.variables(), 82);
  EXPECT_EQ(load_scene("four-bar:9999").model.variables(), 20'000);
}

TEST(FourBar, LoadsFilled) {
  const Scene scene = load_scene("four-bar:40,fill=0.30");
  EXPECT_EQ(scene.name, "four-bar:40,fill=0.30");
  EXPECT_EQ(scene.four_bar_loops, 40);
  ASSERT_TRUE(scene.fill.has_value());
  EXPECT_EQ(scene.fill->asked, 0.30);
  EXPECT_EQ(scene.fill->seed, kFillSeed);
  EXPECT_NEAR(static_cast<double>(tangent_nonzeros(scene.model)), 0.3 * 82 * 82, 1.0);
}

TEST(FourBar, RefusesBadNumbers) {
  for (const char* text : {"0", "-1", "+3", "3x", "", "1e3", "2.5", " 3", "3 ", "0x3", "007",
                           "1000001", "99999999999999999999", "x", "3;fill=1"}) {
    expect_parts(error_of(std::string("four-bar:") + text),
                 {"four-bar:", "for N, allowed is a whole number from 1 to 100000"});
  }
  for (const char* text : {"", "0", "0.0", "1.01", "-0.5", "+0.5", "nan", "inf", "1e-1", "30%",
                           "0.5x", " 0.5", "."}) {
    expect_parts(error_of(std::string("four-bar:3,fill=") + text),
                 {"for F, allowed is a decimal number above 0, up to 1"});
  }
  expect_parts(error_of("four-bar:3,"), {"found the option \"\", allowed is fill=F"});
  expect_parts(error_of("four-bar:3,fill=0.5,fill=0.5"), {"found the option \"fill=0.5\""});
  for (const char* text : {"", "0", "-1", "1.5", "01", "2147483648"}) {
    expect_parts(error_of(std::string("four-bar:3,fill=0.9,seed=") + text), {"for S, allowed is a whole number"});
  }
  expect_parts(error_of("four-bar:3,fil=0.5"), {"found the option \"fil=0.5\""});
  expect_parts(error_of("four-bar:9,fill=0.01"), {"four-bar:9,fill=0.01", "not reached"});
  expect_parts(error_of("four-bar:9999,fill=1"), {"20000 x 20000", "at most 50000000"});
  EXPECT_THROW(four_bar(0), UsageError);
  EXPECT_THROW(four_bar(kMostLoops + 1), UsageError);
}

TEST(LoadScene, ListsWhatIsAllowed) {
  for (const char* text : {"", "four-bar", "fivebar:3", "no/such/file.json"}) {
    expect_parts(error_of(text), {"no such file", "four-bar:N", "fill=F", "JSON scene file"});
  }
  expect_parts(error_of(kScenes.string()), {"is a directory"});
  expect_parts(error_of(std::string(10'000, 'a')), {"File name too long"});
  expect_parts(error_of("a\nb\x1b\xff"), {"\"a\\x0Ab\\x1B\\xFF\""});
}

TEST(LoadScene, ReadsTheShippedScenes) {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kScenes)) {
    if (entry.path().extension() != ".json" || entry.path().stem() == "scene.schema") continue;
    ++count;
    const Scene scene = load_scene(entry.path().string());
    EXPECT_EQ(scene.name, entry.path().string());
    EXPECT_FALSE(scene.four_bar_loops.has_value());
  }
  EXPECT_GE(count, 4);
}

TEST(LoadScene, FourBarByHandIsTheGeneratedOne) {
  expect_same_model(load_scene((kScenes / "four_bar_2.json").string()).model, Model(four_bar(2)));
}

/// A file name of its own for each run of the tests.
std::filesystem::path temporary_path(const std::string& end) {
  return std::filesystem::temp_directory_path() /
         ("mbs_scene_test_" + std::to_string(std::random_device{}()) + end);
}

TEST(LoadScene, RefusesEmptyAndHugeFiles) {
  const auto path = temporary_path(".json");
  std::ofstream(path).close();
  expect_parts(error_of(path.string()), {path.filename().string(), "is empty"});
  std::filesystem::resize_file(path, (std::uintmax_t{32} << 20) + 1);  // sparse
  expect_parts(error_of(path.string()), {"too large", "33554432 bytes"});
  std::filesystem::remove(path);
}

TEST(LoadScene, NamesAreUtf8WhateverThePath) {
  const auto path = temporary_path("\xff\n.json");
  std::filesystem::copy_file(kScenes / "pendulum.json", path);
  const std::string name = load_scene(path.string()).name;
  EXPECT_TRUE(name.ends_with("\\xFF\\x0A.json")) << name;
  std::filesystem::remove(path);
}

TEST(ParseScene, Defaults) {
  const Model model(parse_scene(pendulum(), "test").model);
  EXPECT_EQ(model.dimension(), 2);
  EXPECT_EQ(model.dot_constraints()[0].value, 4.0);
  EXPECT_EQ(mass_at(model, 0, 0), 1.0);
  EXPECT_EQ(mass_at(model, 1, 0), 0.0);
  EXPECT_EQ(model.force()[0], 0.0);
  EXPECT_DOUBLE_EQ(model.force()[1], -1.5 * 9.81);
  EXPECT_EQ(model.initial_velocity()[0], 1.0);
}

TEST(ParseScene, SpatialWithEveryMember) {
  const Model model(parse_scene(R"(/* all of it */ {"dimension": 3, "gravity": [1, 0, -2],
    "points": [{"name": "G\u00e9", "position": [0, 0, 0], "fixed": true, "velocity": [0, 0, 0]},
               {"name": "B", "position": [1, 0, 0]}, {"name": "C", "position": [1, 2, 0]}],
    "rods": [{"between": ["Gé", "B"], "mass": 0, "length": 1},
             {"name": "BC", "between": ["B", "C"], "mass": 6}],
    "masses": [{"point": "B", "mass": 2}, {"point": "B", "mass": 1}], // twice is fine
    "constraints": [{"name": "square", "type": "dot", "first": ["Gé", "B"], "second": ["B", "C"]},
      {"type": "linear", "terms": [{"point": "C", "axis": "z", "coefficient": 2},
                                   {"point": "B", "axis": "z", "coefficient": -1}], "value": 0}]})",
                                "test")
                        .model);
  EXPECT_EQ(model.variables(), 6);
  ASSERT_EQ(model.constraints(), 4);
  EXPECT_EQ(model.dot_constraints()[0].name, "rods[0]");
  EXPECT_EQ(model.dot_constraints()[0].value, 1.0);
  EXPECT_EQ(model.dot_constraints()[1].name, "rods[1] \"BC\"");
  EXPECT_EQ(model.dot_constraints()[2].name, "constraints[0] \"square\"");
  EXPECT_EQ(model.dot_constraints()[2].value, 0.0);
  EXPECT_EQ(model.linear_constraints()[0].terms[0].coordinate, 2);
  EXPECT_EQ(model.linear_constraints()[0].terms[0].coefficient, -1.0 / std::sqrt(5.0));
  EXPECT_EQ(model.linear_constraints()[0].terms[1].coordinate, 5);
  EXPECT_EQ(mass_at(model, 0, 0), 5.0);
  EXPECT_EQ(mass_at(model, 5, 5), 2.0);
  EXPECT_EQ(mass_at(model, 5, 2), 1.0);
  EXPECT_EQ(model.force()[0], 6.0);   // B: 3 kg and half of the rod's 6
  EXPECT_EQ(model.force()[5], -6.0);  // C: half of the rod
}

TEST(ParseScene, ConstraintValuesDefaultToTheStart) {
  const Model model(parse_scene(R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
    {"name": "B", "position": [1, 2]}, {"name": "C", "position": [4, 3]}],
    "masses": [{"point": "B", "mass": 1}, {"point": "C", "mass": 1}],
    "constraints": [{"type": "dot", "first": ["B", "A"], "second": ["C", "A"]},
      {"type": "linear", "terms": [{"point": "B", "axis": "y", "coefficient": 3}]}]})",
                                "test")
                        .model);
  EXPECT_EQ(model.dot_constraints()[0].value, 10.0);
  EXPECT_EQ(model.linear_constraints()[0].value, 2.0);  // 3 y = 6, to unit length
}

TEST(ParseScene, FreeFlightIsAllowed) {
  const Model model(parse_scene(R"({"points": [{"name": "B", "position": [1, 2]},
    {"name": "C", "position": [4, 3]}], "rods": [{"between": ["B", "C"], "mass": 1}]})",
                                "test")
                        .model);
  EXPECT_EQ(model.variables(), 4);
  EXPECT_EQ(model.constraints(), 1);
}

}  // namespace
}  // namespace mbs
