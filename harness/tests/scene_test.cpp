// Scenes that load, and the one line that every bad one gets.
#include "scene/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "model_math/kinematics.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

const std::filesystem::path kScenes =
    std::filesystem::path(__FILE__).parent_path().parent_path() / "scenes";

std::string error_of(const std::string& text) {
  try {
    load_scene(text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

std::string parse_error_of(std::string_view json) {
  try {
    parse_scene(json, "test.json");
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << '"' << part << "\" is not in: " << message;
  }
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_LT(message.size(), 700u) << message;
}

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
  evaluate_constraints(model, model.initial_position(), residual);
  for (const double value : residual) EXPECT_EQ(value, 0.0);
  constraint_rate(model, model.initial_position(), model.initial_velocity(), residual);
  for (const double value : residual) EXPECT_EQ(value, 0.0);
}

TEST(FourBar, EnergyIsThatOfTheReducedMechanism) {
  // Eq. (9): all cranks turn at 1 rad/s, all couplers move at 1 m/s; heights 1/2 and 1.
  for (const int loops : {1, 4}) {
    const Model model(four_bar(loops));
    const double cranks = loops + 1;
    EXPECT_NEAR(energy(model, model.initial_position(), model.initial_velocity()),
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
                 {"four-bar:", "for N, allowed is a whole number from 1 to 1000000"});
  }
  for (const char* text : {"", "0", "0.0", "1.01", "-0.5", "+0.5", "nan", "inf", "1e-1", "30%",
                           "0.5x", " 0.5", "0.5,fill=0.5", "."}) {
    expect_parts(error_of(std::string("four-bar:3,fill=") + text),
                 {"for F, allowed is a decimal number above 0, up to 1"});
  }
  expect_parts(error_of("four-bar:3,"), {"found the option \"\", allowed is fill=F"});
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
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".json") continue;
    ++count;
    const Scene scene = load_scene(entry.path().string());
    EXPECT_EQ(scene.name, entry.path().string());
    EXPECT_FALSE(scene.four_bar_loops.has_value());
    EXPECT_GE(scene.model.constraints(), 1);
  }
  EXPECT_EQ(count, 4);
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

/// The pendulum with the text `from` replaced.
std::string pendulum(const std::string& from = "", const std::string& to = "") {
  std::string text = R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
    {"name": "B", "position": [0, -2], "velocity": [1, 0]}],
    "rods": [{"name": "rod", "between": ["A", "B"], "mass": 3}]})";
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ParseScene, Defaults) {
  const Model model(parse_scene(pendulum(), "test"));
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
    "rods": [{"between": ["Gé", "B"], "mass": 0, "length": 1.0000000005},
             {"name": "BC", "between": ["B", "C"], "mass": 6}],
    "masses": [{"point": "B", "mass": 2}, {"point": "B", "mass": 1}], // twice is fine
    "constraints": [{"name": "square", "type": "dot", "first": ["Gé", "B"], "second": ["B", "C"]},
      {"type": "linear", "terms": [{"point": "C", "axis": "z", "coefficient": 2},
                                   {"point": "B", "axis": "z", "coefficient": -1}], "value": 0}]})",
                                "test"));
  EXPECT_EQ(model.variables(), 6);
  ASSERT_EQ(model.constraints(), 4);
  EXPECT_EQ(model.dot_constraints()[0].name, "rods[0]");
  EXPECT_EQ(model.dot_constraints()[0].value, 1.0000000005 * 1.0000000005);
  EXPECT_EQ(model.dot_constraints()[1].name, "rods[1] \"BC\"");
  EXPECT_EQ(model.dot_constraints()[2].name, "constraints[0] \"square\"");
  EXPECT_EQ(model.dot_constraints()[2].value, 0.0);
  EXPECT_EQ(model.linear_constraints()[0].terms[0].coordinate, 5);
  EXPECT_EQ(model.linear_constraints()[0].terms[1].coordinate, 2);
  EXPECT_EQ(model.linear_constraints()[0].terms[1].coefficient, -1.0);
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
                                "test"));
  EXPECT_EQ(model.dot_constraints()[0].value, 10.0);
  EXPECT_EQ(model.linear_constraints()[0].value, 6.0);
}

TEST(ParseScene, FreeFlightIsAllowed) {
  const Model model(parse_scene(R"({"points": [{"name": "B", "position": [1, 2]},
    {"name": "C", "position": [4, 3]}], "rods": [{"between": ["B", "C"], "mass": 1}]})",
                                "test"));
  EXPECT_EQ(model.variables(), 4);
  EXPECT_EQ(model.constraints(), 1);
}

struct BadScene {
  std::string json;
  std::vector<std::string> parts;  // of the message
};

void expect_errors(const std::vector<BadScene>& scenes) {
  for (const BadScene& scene : scenes) {
    const std::string message = parse_error_of(scene.json);
    expect_parts(message, scene.parts);
    expect_parts(message, {"test.json: "});
  }
}

TEST(BadJson, IsLocatedWithItsReason) {
  expect_errors({
      {"", {"is empty"}},
      {" \n ", {"malformed JSON at line 2", "unexpected end of input"}},
      {"{\n  \"points\": [,]}", {"line 2, column 14", "unexpected ','"}},
      {"{\"points\": []", {"line 1, column 14", "unexpected end of input"}},
      {"{} {}", {"line 1, column 4", "expected end of input"}},
      {"{\"gravity\": [0, 1e999]}", {"line 1, column 21", "number overflow", "1e999"}},
      {"{\"gravity\": [0, NaN]}", {"line 1, column 17", "invalid literal"}},
      {"{\"points\": \"\xff\"}", {"line 1, column 13", "ill-formed UTF-8", "\\xFF"}},
      {std::string("{\"a\0b\": 1}", 10), {"line 1, column 4", "control character"}},
      {"\xff\xfe{\0}\0", {"line 1, column 1"}},
      {"{'points': 1}", {"line 1, column 2"}},
      {"{\"points\": [1, // cut\n", {"unexpected end of input"}},
      {"{/* open", {"line 1"}},
      {std::string(100'000, '['), {"[0][0]", "nested too deeply, allowed are 32 levels"}},
      {"[\"" + std::string(100'000, 'x'), {"missing closing quote", "..."}},
      {R"({"points": [{"name": "A", "fixed": true, "name": "B"}]})",
       {"points[0].name: found this key twice"}},
      {R"({"rods": [], "masses": [], "rods": []})", {"rods: found this key twice"}},
  });
}

TEST(BadScene, WrongShapes) {
  expect_errors({
      {"[]", {"top level: found an array of 0, allowed is an object"}},
      {"3", {"top level: found 3, allowed is an object"}},
      {"{}", {"top level: found no key \"points\""}},
      {R"({"points": {}})", {"points: found an object, allowed is an array"}},
      {R"({"points": []})", {"points: found no free point"}},
      {R"({"points": [5]})", {"points[0]: found 5, allowed is an object"}},
      {R"({"points": [], "rod": []})", {"top level", "unknown key \"rod\"", "nearest is \"rods\""}},
      {pendulum("\"mass\"", "\"mas\""), {"rods[0]", "unknown key \"mas\"", "\"mass\""}},
      {pendulum("\"position\"", "\"pos\\nition\""),
       {"points[0]", "unknown key \"pos\\x0Aition\"", "nearest is \"position\""}},
      {pendulum("true", "1"), {"points[0].fixed: found 1, allowed is true or false"}},
      {pendulum("3}", "\"heavy\"}"), {"rods[0].mass: found \"heavy\", allowed is a number"}},
      {pendulum("3}", "null}"), {"rods[0].mass: found null, allowed is a number"}},
      {pendulum(", \"mass\": 3"), {"rods[0]: found no key \"mass\""}},
      {pendulum("[0, -2]", "[0, -2, 1]"), {"points[1].position", "array of 3", "of 2 numbers"}},
      {pendulum("[0, -2]", "[0, \"x\"]"), {"points[1].position[1]: found \"x\""}},
      {pendulum("\"points\"", "\"dimension\": 4, \"points\""), {"dimension: found 4", "2 or 3"}},
      {pendulum("\"points\"", "\"gravity\": [1], \"points\""), {"gravity", "array of 2 numbers"}},
      {pendulum("[\"A\", \"B\"]", "[\"A\"]"), {"rods[0].between", "array of two point names"}},
      {pendulum("[\"A\", \"B\"]", "[\"A\", 2]"), {"rods[0].between[1]: found 2", "a string"}},
      {pendulum("\"B\"]", "\"C\"]"), {"rods[0].between[1]: found \"C\"", "(A, B)"}},
      {pendulum("\"name\": \"B\"", "\"name\": \"A\""),
       {"points[1].name: found \"A\"", "points[0]"}},
  });
  for (const char* name : {"", "a,b", "a\\nb", "a\\\"b", " a", "a ", "\\u0000", "\\t", "'"}) {
    expect_errors({{pendulum("\"name\": \"B\"", std::string("\"name\": \"") + name + '"'),
                    {"points[1].name", "a name without comma"}}});
  }
}

TEST(BadScene, Physics) {
  const std::string mass = R"("masses": [{"point": "B", "mass": 1}])";
  expect_errors({
      {pendulum("3}", "-1}"), {"rods[0].mass: found -1", "at least 0"}},
      {pendulum("3}", "1e60}"), {"rods[0].mass: found 1e+60", "magnitude up to 1e+50"}},
      {pendulum("3}", "0}"), {"points[1] \"B\": found a free point without mass"}},
      {pendulum("[0, -2]", "[0, 0]"), {"rods[0].between: found a rod of length 0"}},
      {pendulum("[0, -2]", "[1e-200, 0]"), {"rods[0].between: found a rod of length 0"}},
      {pendulum("3}", "3, \"length\": 2.1}"),
       {"rods[0].length: found 2.1", "\"A\" and \"B\" start 2 apart"}},
      {pendulum("3}", "3, \"length\": -2}"), {"rods[0].length: found -2", "above 0"}},
      {pendulum("[\"A\", \"B\"]", "[\"B\", \"B\"]"), {"rods[0].between", "\"B\" twice"}},
      {pendulum("[1, 0]}", "[1, 0], \"fixed\": true}"), {"points[1].velocity", "fixed"}},
      {pendulum("\"velocity\": [1, 0]", "\"fixed\": true"),
       {"rods[0].between", "two fixed points", "over-fixed"}},
      {pendulum("[{\"name\": \"A\"", R"([{"name": "U", "position": [7, 7], "fixed": true},
                {"name": "A")"),
       {"points[0] \"U\": found an unconnected point"}},
      {pendulum("[{\"name\": \"A\"", R"([{"name": "U", "position": [7, 7]}, {"name": "A")"),
       {"points[0] \"U\": found an unconnected point"}},
      {pendulum("\"mass\": 3}", R"("mass": 3}, {"between": ["B", "A"], "mass": 0})"),
       {"rods[1]: found the same points as in rods[0]", "redundant"}},
      {pendulum("\"rods\"", R"("masses": [{"point": "A", "mass": 1}], "rods")"),
       {"masses[0].point", "fixed point \"A\""}},
      {pendulum("\"rods\"", R"("masses": [{"point": "B", "mass": 0}], "rods")"),
       {"masses[0].mass: found 0", "above 0"}},
      {pendulum("[1, 0]", "[1, 0.5]"),
       {"rods[0] \"rod\": the initial velocities violate it: Phi_q v = -2 m^2/s", "1e-06"}},
  });
}

/// The pendulum with these constraints added, in JSON.
std::string constrained(const std::string& constraints) {
  return pendulum("\"rods\"", "\"constraints\": [" + constraints + "], \"rods\"");
}

std::string linear(const std::string& terms, const std::string& rest = "") {
  return R"({"type": "linear", "terms": [)" + terms + "]" + rest + "}";
}

TEST(BadScene, Constraints) {
  const std::string x = R"({"point": "B", "axis": "x", "coefficient": 1})";
  const std::string y = R"({"point": "B", "axis": "y", "coefficient": -2})";
  expect_errors({
      {constrained("{}"), {"constraints[0]: found no key \"type\""}},
      {constrained(R"({"type": "angle"})"), {"constraints[0].type", "\"dot\" or \"linear\""}},
      {constrained(R"({"type": "dot", "terms": []})"), {"constraints[0]", "key \"terms\""}},
      {constrained(R"({"type": "dot", "first": ["A", "B"]})"), {"no key \"second\""}},
      {constrained(R"({"type": "dot", "first": ["A", "B"], "second": ["B", "A"]})"),
       {"constraints[0]: found the same points as in rods[0]"}},
      {constrained(linear("")), {"constraints[0].terms", "1 to 10000 terms"}},
      {constrained(linear(x + "," + x)), {"terms[1]: found the same coordinate as in"}},
      {constrained(linear(x) + "," + linear(R"({"point": "B", "axis": "x", "coefficient": 2})")),
       {"constraints[1]: found the same coefficients as in constraints[0]"}},
      {constrained(linear(R"({"point": "A", "axis": "x", "coefficient": 1})")),
       {"terms[0].point", "fixed point \"A\""}},
      {constrained(linear(R"({"point": "B", "axis": "z", "coefficient": 1})")),
       {"terms[0].axis: found \"z\", allowed is \"x\" or \"y\""}},
      {constrained(linear(R"({"point": "B", "axis": "xy", "coefficient": 1})")), {"axis"}},
      {constrained(linear(R"({"point": "B", "axis": "", "coefficient": 1})")), {"axis"}},
      {constrained(linear(R"({"point": "B", "axis": "x", "coefficient": 0})")),
       {"coefficient: found 0"}},
      {constrained(linear(y, R"(, "value": 5)")),
       {"constraints[0]: the initial position violates it: Phi = -1 m", "1e-08"}},
      {constrained(linear(x)), {"constraints[0]: the initial velocities violate it"}},
  });
}

TEST(BadScene, OverFixedOrImmovable) {
  const std::string held = R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
    {"name": "B", "position": [1, 0], "fixed": true},
    {"name": "C", "position": [2, 0.5], "fixed": true},
    {"name": "P", "position": [1, 1]}, {"name": "Q", "position": [1, 3]}],
    "rods": [{"between": ["P", "Q"], "mass": 1}, {"between": ["A", "P"], "mass": 1},
             {"between": ["B", "P"], "mass": 1})";
  // A and B hold P exactly, and Q swings about it.
  std::string without_c = held;
  const std::string c = R"({"name": "C", "position": [2, 0.5], "fixed": true},)";
  without_c.erase(without_c.find(c), c.size());
  EXPECT_EQ(parse_error_of(without_c + "]}"), "no error");
  expect_errors({
      {held + R"(, {"between": ["P", "C"], "mass": 1}]})",
       {"points[3] \"P\": found an over-fixed point", "rods[1], rods[2], rods[3]"}},
      {held + R"(, {"between": ["Q", "C"], "mass": 1}]})",
       {"cannot move", "all 4 coordinates", "at least one degree of freedom"}},
      {R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
           {"name": "B", "position": [1, 0]}], "rods": [{"between": ["A", "B"], "mass": 1}],
           "constraints": [{"type": "linear",
                            "terms": [{"point": "B", "axis": "y", "coefficient": 1}]}]})",
       {"cannot move", "all 2 coordinates"}},
  });
  // Three parallel cranks are redundant but move.
  EXPECT_EQ(parse_error_of(R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
    {"name": "B", "position": [1, 0], "fixed": true},
    {"name": "C", "position": [2, 0], "fixed": true},
    {"name": "P", "position": [0, 1]}, {"name": "Q", "position": [1, 1]},
    {"name": "R", "position": [2, 1]}],
    "rods": [{"between": ["P", "Q"], "mass": 1}, {"between": ["Q", "R"], "mass": 1},
             {"between": ["P", "R"], "mass": 1}, {"between": ["A", "P"], "mass": 1},
             {"between": ["B", "Q"], "mass": 1}, {"between": ["C", "R"], "mass": 1}]})"),
            "no error");
}

TEST(BadScene, OverFixedBeyondTheRankLimit) {
  // A row of 201 points, all tied to their neighbour and the ground twice: n = 402, m = 600.
  std::string points = R"({"name": "G", "position": [0.3, -1], "fixed": true},
                          {"name": "H", "position": [0.7, -2], "fixed": true})";
  std::string rods;
  for (int i = 0; i < 201; ++i) {
    const std::string name = "P" + std::to_string(i);
    points += R"(, {"name": ")" + name + R"(", "position": [)" + std::to_string(i) + ", 1]}";
    for (const std::string& other : {std::string("G"), std::string("H")}) {
      rods += (rods.empty() ? "" : ",") +
              (R"({"mass": 1, "between": [")" + name + R"(", ")" + other) + R"("]})";
    }
    if (i == 0) continue;
    rods += R"(, {"mass": 1, "between": [")" + name + R"(", "P)" + std::to_string(i - 1) + R"("]})";
  }
  expect_errors({{R"({"points": [)" + points + R"(], "rods": [)" + rods + "]}",
                  {"found 602 constraints on 402 coordinates"}}});
}

TEST(BadScene, MutationsNeverCrash) {
  // Loads or throws UsageError; anything else fails the test, memory errors under the sanitizers.
  std::vector<std::string> seeds;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    std::ifstream file(entry.path());
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  std::mt19937 random(1);
  const auto below = [&](std::size_t limit) { return limit == 0 ? 0 : random() % limit; };
  const std::string alphabet =
      "{}[]\",:0123456789-.eE \n\\\xc3\xff"
      "ABxyz";
  int loaded = 0;
  for (int round = 0; round < 1500; ++round) {
    std::string text = seeds[below(seeds.size())];
    for (std::size_t i = 0; i <= below(4); ++i) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0:
          text.insert(at, 1, alphabet[below(alphabet.size())]);
          break;
        case 1:
          text.erase(at, below(12));
          break;
        case 2:
          text[at] = alphabet[below(alphabet.size())];
          break;
        default:
          text.insert(at, text.substr(below(text.size()), below(60)));
      }
    }
    try {
      const Model model(parse_scene(text, "mutation"));
      EXPECT_TRUE(std::isfinite(energy(model, model.initial_position(), model.initial_velocity())));
      ++loaded;
    } catch (const UsageError& error) {
      EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
    }
  }
  EXPECT_GT(loaded, 50);
}

}  // namespace
}  // namespace mbs
