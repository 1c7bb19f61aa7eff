// The one line that every bad JSON scene gets.
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
      {pendulum() + std::string("\0 {", 3), {"line 3", "a NUL byte"}},
      {std::string("/*\0*/", 5) + pendulum(), {"line 1, column 3", "<U+0000>"}},
      {"// caf\xe9\n" + pendulum(), {"line 1, column 7", "ill-formed UTF-8"}},
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
      {pendulum("\"position\": [0, -2], ", ""), {"points[1]: found no key \"position\"", "a body"}},
      {pendulum("\"position\": [0, 0], ", ""), {"points[0]: found no key \"position\""}},
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
  for (const char* name :
       {"", "a,b", "a\\nb", "a\\\"b", " a", "a ", "\\u0000", "\\t", "'", "+a", "-a", "@a"}) {
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
      {pendulum("3}", "3, \"length\": 2.3}"),
       {"\"B\" would move by 0.3 m", "allowed is 0.2 m (assembly.largest_correction)",
        "rods[0] \"rod\": its points are 2 m apart, its length is 2.3 m"}},
      {pendulum("3}", "3, \"length\": -2}"), {"rods[0].length: found -2", "above 0"}},
      {pendulum("[\"A\", \"B\"]", "[\"B\", \"B\"]"), {"rods[0].between", "\"B\" twice"}},
      {pendulum("[1, 0]}", "[1, 0], \"fixed\": true}"), {"points[1].velocity", "fixed"}},
      {pendulum("\"velocity\": [1, 0]", "\"fixed\": true"),
       {"rods[0].between", "only fixed or driven points", "over-fixed"}},
      {pendulum("[{\"name\": \"A\"", R"([{"name": "U", "position": [7, 7], "fixed": true},
                {"name": "A")"),
       {"points[0]: found an unconnected point"}},
      {pendulum("[{\"name\": \"A\"", R"([{"name": "U", "position": [7, 7]}, {"name": "A")"),
       {"points[0]: found an unconnected point"}},
      {pendulum("\"mass\": 3}", R"("mass": 3}, {"between": ["B", "A"], "mass": 0})"),
       {"rods[1]: found the same points as in rods[0]", "redundant"}},
      {pendulum("\"rods\"", R"("masses": [{"point": "A", "mass": 1}], "rods")"),
       {"masses[0].point", "fixed or driven point \"A\""}},
      {pendulum("\"rods\"", R"("masses": [{"point": "B", "mass": 0}], "rods")"),
       {"masses[0].mass: found 0", "above 0"}},
      {pendulum("[1, 0]", "[1, 0.5]"),
       {"the velocities contradict the constraints: that of \"B\"", "rods[0] \"rod\"", "-2 m^2/s"}},
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
      {constrained(R"({"type": "angle"})"), {"constraints[0]: found no key \"first\""}},
      {constrained(R"({"type": "dot", "terms": []})"), {"constraints[0]", "key \"terms\""}},
      {constrained(R"({"type": "dot", "first": ["A", "B"]})"), {"no key \"second\""}},
      {constrained(R"({"type": "dot", "first": ["A", "B"], "second": ["B", "A"]})"),
       {"constraints[0]: found the same points as in rods[0]"}},
      {constrained(linear("")), {"constraints[0].terms", "1 to 10000 terms"}},
      {constrained(linear(x + "," + x)), {"terms[1]: found the same coordinate as in"}},
      {constrained(linear(x) + "," + linear(R"({"point": "B", "axis": "x", "coefficient": 2})")),
       {"constraints[1]: found the same coefficients as in constraints[0]", "redundant"}},
      {constrained(linear(x, R"(, "value": 1)") + "," +
                   linear(R"({"point": "B", "axis": "x", "coefficient": 2})", R"(, "value": 2.1)")),
       {"constraints[1]: found the same coefficients as in constraints[0]",
        "the value 1.05 m where that has 1 m: they contradict each other"}},
      {constrained(linear(R"({"point": "A", "axis": "x", "coefficient": 1})")),
       {"terms[0].point", "fixed or driven point \"A\""}},
      {constrained(linear(R"({"point": "B", "axis": "z", "coefficient": 1})")),
       {"terms[0].axis: found \"z\", allowed is \"x\" or \"y\""}},
      {constrained(linear(R"({"point": "B", "axis": "xy", "coefficient": 1})")), {"axis"}},
      {constrained(linear(R"({"point": "B", "axis": "", "coefficient": 1})")), {"axis"}},
      {constrained(linear(R"({"point": "B", "axis": "x", "coefficient": 0})")),
       {"coefficient: found 0"}},
      {constrained(linear(y, R"(, "value": 5)")),
       {"the start cannot be assembled", "rods[0] \"rod\": its points are"}},
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

/// Two rods from fixed points 2 m apart, along one line.
std::string stretched(const std::string& length) {
  return R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
    {"name": "B", "position": [2, 0], "fixed": true}, {"name": "C", "position": [1, 0]}],
    "rods": [{"between": ["A", "C"], "mass": 1},
             {"name": "last", "between": ["B", "C"], "mass": 1, "length": )" +
         length + "}]}";
}

TEST(BadScene, StretchedIsImmovable) {
  expect_errors({{stretched("1"), {"cannot move", "1 of 2 coordinates"}}});
  // A third parallel crank of another length: off by less than six digits may show.
  expect_errors({{R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
    {"name": "B", "position": [1, 0], "fixed": true}, {"name": "C", "position": [2, 0], "fixed": true},
    {"name": "P", "position": [0, 1]}, {"name": "Q", "position": [1, 1]},
    {"name": "R", "position": [2, 1]}],
    "bodies": [{"name": "K", "mass": 1, "inertia": 1, "points": {"P": [0, 0], "Q": [1, 0],
                "R": [2, 0]}}],
    "rods": [{"between": ["A", "P"], "mass": 1}, {"between": ["B", "Q"], "mass": 1},
             {"between": ["C", "R"], "mass": 1, "length": 1.00001}]})",
                  {"cannot be assembled", "apart, its length is 1", "a difference of "}}});
}

TEST(BadScene, GivenPointsThatAreNoCoordinatesCount) {
  const auto triangle = [](const std::string& c, const std::string& rest = "") {
    return R"({"points": [{"name": "A", "position": [0, 0]}, {"name": "B", "position": [1, 0]},
      {"name": "C", "position": )" +
           c + R"(}], "bodies": [{"name": "L", "mass": 1, "inertia": 0.1,
      "points": {"A": [0, 0], "B": [1, 0], "C": [1, 1]}}])" +
           rest + "}";
  };
  EXPECT_EQ(parse_error_of(triangle("[1, 1]")), "no error");
  EXPECT_EQ(parse_error_of(triangle("[1.02, 1]")), "no error");
  EXPECT_GT(parse_scene(triangle("[1.02, 1]"), "test").assembly.position_correction, 0.004);
  const std::string lenient = R"(, "assembly": {"largest_correction": 10})";
  expect_errors({{triangle("[1, 1.6]"), {"would move by 0.", "allowed is 0.0"}},
                 {triangle("[1, -1]"), {"bodies[0]: found points", "mirror image"}},
                 {triangle("[1, -1]", lenient), {"mirror image"}}});
}

TEST(BadScene, GivenVelocitiesOfPointsThatAreNoCoordinatesCount) {
  const auto crank = [](const std::string& velocity) {
    return R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
      {"name": "B", "position": [1, 0], "velocity": )" +
           velocity + R"(}], "bodies": [{"name": "L", "mass": 1, "inertia": 0.1,
      "angular_velocity": 1, "points": {"A": [0, 0], "B": [1, 0]}}]})";
  };
  EXPECT_EQ(parse_error_of(crank("[0, 1]")), "no error");
  EXPECT_EQ(parse_error_of(crank("[0, 1.05]")), "no error");
  EXPECT_NEAR(parse_scene(crank("[0, 1.05]"), "test").assembly.velocity_correction, 0.05, 1e-12);
  expect_errors({{crank("[0, 3]"),
                  {"points[1].velocity: the velocities contradict", "that of \"B\", 3 m/s",
                   "change by 2 m/s, allowed is 0.3 m/s"}}});
}

/// Two masses at one place, and what turns the direction between them.
TEST(BadScene, NothingTurnsADirectionOfNoLength) {
  const std::string scene = R"({"points": [{"name": "O", "position": [0, 0], "fixed": true},
    {"name": "X", "position": [1, 0], "fixed": true}, {"name": "P", "position": [1, 1]},
    {"name": "Q", "position": [1, 1]}],
    "masses": [{"point": "P", "mass": 1}, {"point": "Q", "mass": 1}], )";
  const std::string law = R"({"from": ["O", "X"], "to": ["P", "Q"], )";
  for (const std::string& element :
       {R"("torsion_springs": [)" + law + R"("stiffness": 1}])",
        R"("torque_laws": [)" + law + R"("by_rate": {"rates": [0, 1], "torques": [0, 1]}}])",
        std::string(R"("springs": [{"between": ["O", "P"]}, {"between": ["X", "P"]}],
                      "torques": [{"direction": ["P", "Q"], "torque": 1}])")}) {
    expect_errors(
        {{scene + element + "}", {"[0]: found a direction between points", "same place"}}});
  }
}

TEST(BadScene, VelocityAlongARodIsNamed) {
  expect_errors({{pendulum("[1, 0]", "[0, 0.5]"),
                  {"points[1].velocity: the velocities contradict", "that of \"B\", 0.5 m/s",
                   "change by 0.5 m/s, allowed is 0.05 m/s"}}});
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
                  {"cannot move: its constraints hold all 402 coordinates"}}});
}

TEST(BadScene, MutationsNeverCrash) {
  // Loads or throws UsageError; anything else fails the test, memory errors under the sanitizers.
  std::vector<std::string> seeds;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kScenes)) {
    if (entry.path().extension() != ".json" || entry.path().stem() == "scene.schema") continue;
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
      const Model model(parse_scene(text, "mutation").model);
      EXPECT_TRUE(std::isfinite(kinetic_energy(model, model.initial_velocity()) +
                                potential_energy(model, 0.0, model.initial_position())));
      ++loaded;
    } catch (const UsageError& error) {
      EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
    }
  }
  EXPECT_GT(loaded, 50);
}

}  // namespace
}  // namespace mbs
