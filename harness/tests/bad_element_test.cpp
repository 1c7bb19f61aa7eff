// The one line that mistakes in bodies, constraints, forces, drivers and outputs get.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/scene_support.hpp"

namespace mbs {
namespace {

struct Edit {
  std::string from, to;
  std::vector<std::string> parts;  // of the message
};

/// `text` with each edit made alone gives its message; without any it is fine.
void expect_edits(const std::string& text, const std::vector<Edit>& edits) {
  EXPECT_EQ(parse_error_of(text), "no error");
  for (const Edit& edit : edits) {
    const auto at = text.find(edit.from);
    ASSERT_NE(at, std::string::npos) << edit.from;
    std::string changed = text;
    changed.replace(at, edit.from.size(), edit.to);
    const std::string message = parse_error_of(changed);
    expect_parts(message, edit.parts);
    expect_parts(message, {"test.json: "});
  }
}

const std::string kPlanar = R"({
  "points": [{"name": "O", "position": [0, 0], "fixed": true},
             {"name": "X", "position": [3, 0], "fixed": true},
             {"name": "road", "driven": {"x": 5, "y": {"sine": {"amplitude": 1, "frequency": 2}}}},
             {"name": "E", "position": [1, 0]}, {"name": "P", "position": [2, 1]}],
  "bodies": [{"name": "crank", "mass": 1, "inertia": 0.1, "points": {"O": [0, 0], "E": [1, 0]}},
             {"name": "rod", "mass": 1, "inertia": 0.1, "centre": [0.5, 0],
              "points": {"E": [0, 0], "P": [1.4142135623730951, 0], "D": [0.5, 0.5]}}],
  "constraints": [{"name": "slot", "type": "on_line", "point": "D", "line": ["O", "X"]}],
  "springs": [{"name": "s", "between": ["road", "P"], "stiffness": 1, "length": 2}],
  "torsion_springs": [{"name": "ts", "from": ["O", "E"], "to": ["E", "P"], "stiffness": 1}],
  "forces": [{"point": "P", "force": [1, 2]}],
  "torques": [{"body": "crank", "torque": 1}],
  "assembly": {"largest_correction": 3},
  "outputs": [{"name": "D", "position": "D"}, {"name": "f", "constraint_force": "slot"}]})";

TEST(BadElement, PlanarBodies) {
  expect_edits(
      kPlanar,
      {{R"("mass": 1, "inertia": 0.1, "points")",
        R"("mass": 0, "inertia": 0.1, "points")",
        {"bodies[0].mass: found 0, allowed is a mass in kg above 0"}},
       {R"("inertia": 0.1, "points")",
        R"("inertia": -0.1, "points")",
        {"bodies[0].inertia: found -0.1, allowed is an inertia in kg m^2 above 0"}},
       {R"("inertia": 0.1, "points")",
        R"("inertia": [1, 1, 1], "points")",
        {"bodies[0].inertia: found an array of 3, allowed is a number"}},
       {R"("inertia": 0.1, "points")", R"("points")", {"bodies[0]: found no key \"inertia\""}},
       {R"("centre")", R"("center")", {"bodies[1]", "unknown key \"center\"", "is \"centre\""}},
       {R"("name": "rod")",
        R"("name": "crank")",
        {"bodies[1].name: found \"crank\"", "bodies[0] has it"}},
       {R"("name": "rod")", R"("name": "a,b")", {"bodies[1].name", "without comma"}},
       {R"("E": [1, 0]})",
        R"("E": [1, 0], "X": [3, 0]})",
        {"bodies[0]: found a body that cannot move: \"O\", \"X\" are fixed or driven",
         "one fixed or driven point a body"}},
       {R"("E": [1, 0]})",
        R"("E": [1, 0], "road": [5, 0]})",
        {"bodies[0]: found the driven point \"road\" among 2 fixed or driven points"}},
       {R"("E": [1, 0]})", R"("E": [1]})", {"bodies[0].points.E", "array of 2 numbers"}},
       {R"("E": [1, 0]})",
        R"("E": [1, 0]}, "vectors": {})",
        {"bodies[0].vectors: found unit vectors in a planar scene"}},
       {R"("E": [1, 0]})",
        R"("E": [1, 0]}, "pose": {"rotation": 1})",
        {"bodies[0].pose", "unknown key \"rotation\"", "position"}},
       {R"("E": [1, 0]}},)",
        R"("E": [1, 0]}}, {"name": "lost", "mass": 1, "inertia": 1},)",
        {"bodies[1]: found no place for \"lost.o\"", "a \"pose\", or positions of two"}},
       {R"("E": [1, 0]}},)",
        R"("E": [1, 0]}}, {"name": "far", "mass": 1, "inertia": 1, "centre": [1e20, 0], "pose": {}},)",
        {"bodies[1]: found a size of 1 m, which rounding of its local coordinates hides", "near its centre"}},
       {R"("E": [1, 0]}},)",
        R"("E": [1, 0]}}, {"name": "tiny", "mass": 1e30, "inertia": 1e-300, "pose": {}},)",
        {"bodies[1]: found a size of 0 m", "a larger inertia"}},
       {R"("constraints": [)",
        R"("rods": [{"between": ["E", "D"], "mass": 0}], "constraints": [)",
        {"rods[0].between: found points of one body only (\"rod\")"}},
       {R"("constraints": [)",
        R"("vectors": [{"name": "u"}], "constraints": [)",
        {"vectors[0]: found a unit vector in a planar scene"}}});
}

TEST(BadElement, ConstraintsInThePlane) {
  const std::string slot =
      R"({"name": "slot", "type": "on_line", "point": "D", "line": ["O", "X"]})";
  const auto with = [&](const std::string& constraint, std::vector<std::string> parts) {
    return Edit{slot, slot + ", " + constraint, std::move(parts)};
  };
  expect_edits(
      kPlanar,
      {with(R"({"type": "anlge"})",
            {"constraints[1].type: found \"anlge\"", "coincident", "the nearest is \"angle\""}),
       with("5", {"constraints[1]: found 5, allowed is an object"}),
       with(R"({"name": "slot", "type": "coincident", "points": ["P", "D"]})",
            {"constraints[1].name: found \"slot\"", "constraints[0] has it"}),
       with(R"({"type": "coincident", "points": ["P", "D"]})", {"points of one body only"}),
       with(R"({"type": "coincident", "points": ["P", "P"]})", {"the point \"P\" twice"}),
       with(R"({"type": "coincident", "points": ["O", "X"]})", {"only fixed or driven points"}),
       with(R"({"type": "distance", "between": ["X", "P"], "value": 0})",
            {"constraints[1].value: found 0, allowed is a distance in m above 0"}),
       with(R"({"type": "distance", "between": ["X", "P"], "value": {"polynomial": [-1, 3]}})",
            {"constraints[1].value", "above 0 (at t = 0)"}),
       with(R"({"type": "distance", "between": ["X", "P"], "length": 1})",
            {"unknown key \"length\""}),
       with(R"({"type": "angle", "first": ["O", "E"], "second": ["O", "X"], "value": 3})",
            {"constraints[1]: found an angle of 0 rad at the start", "quarter turn"}),
       with(R"({"type": "angle", "first": "u", "second": ["O", "X"]})",
            {"constraints[1].first", "[\"A\", \"B\"], the direction from one point to another"}),
       with(R"({"type": "angle", "first": ["E", "X"], "second": ["O", "P"],
                "value": {"polynomial": [0.5, 1]}})",
            {"constraints[1].first: found a direction between points whose distance may change"}),
       with(R"({"type": "perpendicular", "first": ["E", "D"], "second": ["E", "P"]})",
            {"points of one body only"}),
       with(R"({"type": "perpendicular", "first": ["E", "D"], "second": ["E", "O"], "value": 1})",
            {"unknown key \"value\""}),
       with(R"({"type": "on_line", "point": "P", "line": ["P", "X"]})",
            {"constraints[1].line: found the point \"P\" itself"}),
       with(R"({"type": "on_line", "point": "D", "line": ["X", "O"]})",
            {"constraints[1]: found the same coefficients as in constraints[0]"}),
       with(R"({"type": "on_line", "point": "P", "line": ["O", "X"], "direction": "u"})",
            {"unknown key \"direction\""}),
       with(R"({"type": "linear", "terms": [{"point": "road", "axis": "x", "coefficient": 1}]})",
            {"terms[0].point: found the fixed or driven point \"road\""})});
}

TEST(BadElement, Forces) {
  expect_edits(
      kPlanar,
      {{R"("stiffness": 1, "length": 2)",
        R"("stiffness": -1)",
        {"springs[0].stiffness: found -1", "at least 0"}},
       {R"("stiffness": 1, "length": 2)",
        R"("stiffness": {"polynomial": [-1, 0]})",
        {"springs[0].stiffness: found a value of springs[0] \"s\" of -1 at all times, allowed is a "
         "stiffness in N/m of at least 0"}},
       {R"("stiffness": 1, "length": 2)",
        R"("stiffness": {"polynomial": [-50, 1e6]})",
        {"springs[0].stiffness: found a value of springs[0] \"s\" of -50 at t = 0 s",
         "at least 0"}},
       {R"("stiffness": 1, "length": 2)",
        R"("damping": {"sine": {"amplitude": 1, "frequency": 1, "phase": -0.1}})",
        {"springs[0].damping: found a value of springs[0] \"s\" of -0.0998", "at t = 0 s"}},
       {R"("stiffness": 1, "length": 2)", R"("stifness": 1)", {"nearest is \"stiffness\""}},
       {R"("stiffness": 1, "length": 2)", R"("damping": -1)", {"springs[0].damping"}},
       {R"("stiffness": 1, "length": 2)", R"("length": -1)", {"springs[0].length"}},
       {R"(["road", "P"])", R"(["road", "X"])", {"springs[0].between: found only fixed"}},
       {R"(["road", "P"])",
        R"(["road", "Q"])",
        {"springs[0].between[1]: found \"Q\"", "the name of a point (O, X, road, E, P, D)"}},
       {R"(["road", "P"])", R"(["raod", "P"])", {"the nearest is \"road\""}},
       {R"(["road", "P"])", R"(["E", "P"])", {"points of one body only"}},
       {R"("ts")", R"("s")", {"torsion_springs[0].name: found \"s\"", "springs[0] has it"}},
       {R"("to": ["E", "P"])",
        R"("to": ["E", "P"], "angle": 3.2)",
        {"torsion_springs[0].angle: found 3.2", "-pi to pi"}},
       {R"("to": ["E", "P"])", R"("to": ["E", "P"], "axis": "z")", {"axis in a planar scene"}},
       {R"("from": ["O", "E"], "to": ["E", "P"])",
        R"("from": ["O", "X"], "to": ["X", "O"])",
        {"torsion_springs[0]: found only fixed"}},
       {R"("force": [1, 2])", R"("force": [1, 2, 3])", {"forces[0].force", "array of 2 numbers"}},
       {R"({"point": "P", "force")",
        R"({"point": "O", "force")",
        {"forces[0].point: found the fixed or driven point \"O\""}},
       {R"({"body": "crank")",
        R"({"body": "crnk")",
        {"torques[0].body: found \"crnk\"", "(crank, rod)", "nearest is \"crank\""}},
       {R"({"body": "crank")", R"({"direction": ["O", "X"])", {"torques[0].direction", "fixed"}},
       {R"({"body": "crank")", R"({"body": "crank", "direction": ["O", "E"])", {"one of the two"}},
       {R"({"body": "crank", )", "{", {"torques[0]: found no key \"direction\""}},
       {R"("torque": 1)", R"("torque": "big")", {"torques[0].torque: found \"big\""}},
       {R"("largest_correction": 3)", R"("largest_correction": -3)", {"assembly.largest", "-3"}},
       {R"("largest_correction": 3)",
        R"("largest_correction": 1e-3)",
        {"the start is too far from its constraints", "allowed is 0.001 m"}}});
}

const std::string kLaws = R"({
  "points": [{"name": "O", "position": [0, 0], "fixed": true},
             {"name": "X", "position": [3, 0], "fixed": true}, {"name": "P", "position": [2, 1]}],
  "masses": [{"point": "P", "mass": 1}],
  "force_laws": [{"name": "stop", "between": ["O", "P"],
                  "by_length": {"lengths": [1, 2, 3], "forces": [-9, 0, 0]},
                  "by_rate": {"rates": [-1, 1], "forces": [-5, 5]}}],
  "torque_laws": [{"name": "motor", "from": ["O", "X"], "to": ["O", "P"],
                   "by_rate": {"rates": [0, 100], "torques": [7, 0]}, "factor": -1}]})";

TEST(BadElement, Laws) {
  expect_edits(
      kLaws,
      {{"[1, 2, 3]",
        "[1, 1, 3]",
        {"force_laws[0].by_length.lengths[1]: found 1, allowed is a number above the one before"}},
       {"[1, 2, 3]", "[1, 3, 2]", {"lengths[2]: found 2, allowed is a number above", "before, 3"}},
       {"[1, 2, 3]", "[1, 2]", {"by_length.forces: found 3 forces for 2 lengths", "as many"}},
       {"[1, 2, 3]", "[1]", {"by_length.lengths: found 1 of lengths, allowed is at least 2"}},
       {"[1, 2, 3]", "[1, 2, 1e60]", {"by_length.lengths[2]: found 1e+60"}},
       {"[1, 2, 3]", "[0, 1e-200, 3]", {"by_length.lengths[1]: found rows so close together"}},
       {"[-9, 0, 0]", "[-9, \"x\", 0]", {"by_length.forces[1]: found \"x\""}},
       {R"("lengths")", R"("angles")", {"unknown key \"angles\"", "lengths, forces"}},
       {R"("by_length")", R"("by_angle")", {"force_laws[0]", "unknown key \"by_angle\""}},
       {R"("between": ["O", "P"])", R"("from": ["O", "P"])", {"unknown key \"from\""}},
       {R"(["O", "P"],)", R"(["O", "X"],)", {"force_laws[0].between: found only fixed"}},
       {R"("by_rate": {"rates": [0, 100], "torques": [7, 0]}, )",
        "",
        {"torque_laws[0]: found a law without a table, allowed is by_angle, by_rate or both"}},
       {R"("motor")", R"("stop")", {"torque_laws[0].name: found \"stop\"", "force_laws[0] has it"}},
       {R"("factor": -1)", R"("factor": "x")", {"torque_laws[0].factor", "without unit"}},
       {R"("factor": -1)", R"("axis": "z")", {"axis in a planar scene"}}});
}

TEST(BadElement, Drivers) {
  const std::string sine = R"({"sine": {"amplitude": 1, "frequency": 2}})";
  const auto driver = [&](const std::string& function, std::vector<std::string> parts) {
    return Edit{sine, function, std::move(parts)};
  };
  std::string corner_times, corner_values;
  for (int i = 0; i <= 20; ++i) {
    corner_times += (i == 0 ? "" : ", ") + std::to_string(0.1 * i);
    corner_values += (i == 0 ? "" : ", ") + std::to_string(std::abs(0.1 * i - 1));
  }
  expect_edits(
      kPlanar,
      {driver("\"fast\"", {"points[2].driven.y: found \"fast\"", "polynomial, sine, table or input"}),
       driver("{}", {"points[2].driven.y: found an object with 0 members"}),
       driver(R"({"sin": 1})", {"points[2].driven.y", "unknown key \"sin\"", "is \"sine\""}),
       driver(R"({"sine": 1, "polynomial": [1, 2]})", {"2 members", "one of polynomial, sine"}),
       driver(R"({"polynomial": []})", {"driven.y.polynomial", "1 to 32 numbers"}),
       driver(R"({"polynomial": ["a"]})", {"driven.y.polynomial[0]: found \"a\""}),
       driver(R"({"sine": {"amplitude": 1}})", {"driven.y.sine: found no key \"frequency\""}),
       driver(R"({"sine": {"amplitude": 1, "frequency": -2}})", {"frequency: found -2"}),
       driver(R"({"table": {"times": [0, 1, 2], "values": [0, 1, 2]}})",
              {"table.times", "at least 4 times"}),
       driver(R"({"table": {"times": [0, 1, 2, 3], "values": [0, 1, 2]}})",
              {"table.values", "as many values as times, 4"}),
       driver(R"({"table": {"times": [0, 1, 1, 3], "values": [0, 1, 2, 3]}})",
              {"table.times[2]: found 1, allowed is a time above the one before, 1"}),
       driver(R"({"table": {"times": [0.5, 1, 2, 3], "values": [0, 1, 2, 3]}})",
              {"table.times[0]: found 0.5, allowed is a first time of at most 0"}),
       driver(
           R"({"table": {"times": [)" + corner_times + R"(], "values": [)" + corner_values + "]}}",
           {"table.values[10]: found a corner at t = 1 s", "a smooth function"}),
       {R"("driven": {"x": 5, )", R"("driven": {)", {"points[2].driven: found no key \"x\""}},
       {R"("driven": {"x": 5, )", R"("driven": {"z": 5, )", {"points[2].driven", "key \"z\""}},
       {R"({"name": "road", )",
        R"({"name": "road", "position": [0, 0], "fixed": true, )",
        {"points[2].driven: found a driven point that is fixed"}},
       {R"({"name": "road", )",
        R"({"name": "road", "velocity": [0, 1], )",
        {"points[2].velocity: found a moving fixed or driven point"}}});
}

TEST(BadElement, Outputs) {
  const auto output = [](const std::string& text, std::vector<std::string> parts) {
    return Edit{R"({"name": "D", "position": "D"})", text, std::move(parts)};
  };
  expect_edits(
      kPlanar,
      {output(R"({"name": "D", "position": "F"})", {"outputs[0].position: found \"F\""}),
       output(R"({"name": "D"})", {"outputs[0]: found 0 quantities", "one of position"}),
       output(R"({"name": "D", "position": "D", "velocity": "D"})", {"found 2 quantities"}),
       output(R"({"position": "D"})", {"outputs[0]: found no key \"name\""}),
       output(R"({"name": "a,b", "position": "D"})", {"outputs[0].name", "without comma"}),
       output(R"({"name": "f", "position": "D"})", {"outputs[1].name: found \"f\"", "outputs[0]"}),
       output(R"({"name": "t", "energy": "total"})",
              {"outputs[0].name: found \"t\"", "column \"t\"", "the time has it"}),
       output(R"({"name": "D", "position": "D"}, {"name": "D.vx", "energy": "total"},
                 {"name": "D.y", "energy": "total"})",
              {"outputs[2].name: found \"D.y\"", "outputs[0].name has it"}),
       output(R"({"name": "e", "energy": "kinetick"})", {"nearest is \"kinetic\""}),
       output(R"({"name": "a", "angle": [["O", "E"]]})", {"an array of two directions"}),
       output(R"({"name": "a", "angle": [["O", "E"], ["O", "X"]], "axis": "z"})", {"an axis"}),
       output(R"({"name": "a", "distance": ["O", "O"]})", {"the point \"O\" twice"}),
       output(R"({"name": "c", "constraint_force": "slt"})",
              {"outputs[0].constraint_force: found \"slt\"", "a rod or constraint",
               "nearest is \"slot\""}),
       output(R"({"name": "c", "constraint_force": "crank"})",
              {"outputs[0].constraint_force: found \"crank\"", "a rod or constraint (slot)"})});
}

const std::string kSpatial = R"({"dimension": 3,
  "points": [{"name": "A", "position": [0, 0, 0], "fixed": true},
             {"name": "B", "position": [0, 1, 0], "fixed": true},
             {"name": "C", "position": [1, 0, 0], "fixed": true},
             {"name": "M", "position": [0.5, 0, 0]}],
  "vectors": [{"name": "x", "direction": [2, 0, 0], "fixed": true},
              {"name": "y", "direction": [0, 1, 0], "fixed": true}],
  "bodies": [{"name": "door", "mass": 1, "inertia": [1, 1, 1.5],
              "points": {"A": [0, 0, 0], "D": [1, 0, 0]}, "vectors": {"y": [0, 1, 0]},
              "pose": {"rotation": [0, 0.5, 0]}},
             {"name": "sled", "mass": 1, "inertia": [1, 1, 1], "points": {"M": [0, 0, 0]},
              "vectors": {"w": [0, 0, 1]}, "pose": {}}],
  "constraints": [{"name": "rail", "type": "on_line", "point": "M", "line": "A", "direction": "x"}],
  "springs": [{"between": ["M", "B"]}, {"between": ["M", "C"]}],
  "torques": [{"body": "door", "axis": "y", "torque": 1}]})";

TEST(BadElement, SpatialBodies) {
  expect_edits(
      kSpatial,
      {{"[1, 1, 1.5]",
        "[1, 1, 2.5]",
        {"bodies[0].inertia: found a tensor that no body",
         "smaller than the sum of the other two"}},
       {"[1, 1, 1.5]", "[1, 1, 2]", {"bodies[0].inertia"}},
       {"[1, 1, 1.5]", "[1, -1, 1]", {"bodies[0].inertia", "positive principal moments"}},
       {"[1, 1, 1.5]", "[1, 1, 1, 2, 0, 0]", {"bodies[0].inertia"}},
       {"[1, 1, 1.5]", "[1, 1]", {"[xx, yy, zz] or [xx, yy, zz, xy, xz, yz]"}},
       {"[1, 1, 1.5]", "3", {"bodies[0].inertia: found 3, allowed is an array"}},
       {R"("D": [1, 0, 0]})",
        R"("D": [1, 0, 0], "y": [1, 0, 0]})",
        {"bodies[0].points.y: found the unit vector \"y\", allowed is a point"}},
       {R"({"y": [0, 1, 0]})", R"({"D": [0, 1, 0]})", {"bodies[0].vectors.D: found the point"}},
       {R"({"y": [0, 1, 0]})", R"({"y": [0, 0, 0]})", {"bodies[0].vectors.y", "of length 0"}},
       {R"("D": [1, 0, 0]})",
        R"("D": [1, 0, 0], "C": [1, 0, 0]})",
        {"bodies[0]: found a body that cannot move", "a fixed axis"}},
       {R"("D": [1, 0, 0]})",
        R"("D": [1, 0, 0], "B": [0, 2, 0]})",
        {"bodies[0]: found fixed points or vectors that do not fit", "\"y\" off by"}},
       {R"("pose": {}})", R"("pose": {"angle": 1}})", {"bodies[1].pose", "unknown key \"angle\""}},
       {R"(, "pose": {}})",
        "}",
        {"bodies[1]: found no place for \"w\"", "only M have one", "positions of three"}},
       {R"("direction": [2, 0, 0])", R"("direction": [0, 0, 0])", {"vectors[0].direction"}},
       {R"({"name": "x", "direction": [2, 0, 0], "fixed": true})",
        R"({"name": "x", "fixed": true})",
        {"vectors[0]: found no key \"direction\""}},
       {R"("name": "x")", R"("name": "A")", {"vectors[0].name: found \"A\"", "points[0] has it"}}});
}

TEST(BadElement, ConstraintsInSpace) {
  const std::string rail = R"("direction": "x"})";
  const auto with = [&](const std::string& constraint, std::vector<std::string> parts) {
    return Edit{rail, rail + ", " + constraint, std::move(parts)};
  };
  expect_edits(
      kSpatial,
      {{R"("direction": "x"})", R"("direction": "A"})", {"direction: found the point \"A\""}},
       {R"("line": "A")", R"("line": ["A", "B"])", {"line: found an array of 2", "a string"}},
       {R"("line": "A")", R"("line": "M")", {"line: found the point \"M\" itself"}},
       {R"("axis": "y")",
        R"("axis": "x")",
        {"torques[0].axis: found the unit vector \"x\", which is not one of \"door\""}},
       {R"("axis": "y", )", "", {"torques[0]: found no key \"axis\""}},
       with(R"({"type": "angle", "first": "x", "second": "w", "value": 0})",
            {"constraints[1]: found an angle of 0 rad", "0.01 to pi - 0.01 rad in space"}),
       with(R"({"type": "angle", "first": "x", "second": ["M", "D"], "value": 1})",
            {"constraints[1].second: found a direction between points whose distance may change"}),
       with(R"({"type": "perpendicular", "first": "x", "second": "y"})", {"only fixed"}),
       with(R"({"type": "on_line", "point": "M", "line": "A", "direction": "x"})",
            {"constraints[1]: found the same points as in constraints[0]"}),
       with(R"({"type": "angle", "first": "z", "second": "w"})",
            {"constraints[1].first: found \"z\"", "the name of a point or unit vector"})});
}

TEST(BadElement, MirrorImagesAreRefused) {
  const std::string scene = R"({"dimension": 3, "points": [
    {"name": "A", "position": [0, 0, 0]}, {"name": "B", "position": [1, 0, 0]},
    {"name": "C", "position": [0, 1, 0]}, {"name": "D", "position": [0, 0, 1]}],
    "bodies": [{"name": "K", "mass": 1, "inertia": [1, 1, 1],
                "points": {"A": [0, 0, 0], "B": [1, 0, 0], "C": [0, 1, 0], "D": [0, 0, 1]}}],
    "springs": [{"between": ["A", "G"], "stiffness": 1}]})";
  std::string used = scene;
  used.replace(used.find("\"points\": [\n"), 11,
               R"("points": [{"name": "G", "position": [9, 0, 0], "fixed": true},)");
  const auto springs = used.find("\"springs\"");
  used.replace(springs, std::string::npos,
               R"("springs": [{"between": ["A", "G"]}, {"between": ["B", "G"]},
                  {"between": ["C", "G"]}, {"between": ["D", "G"]}]})");
  expect_edits(used, {{R"("name": "D", "position": [0, 0, 1])",
                       R"("name": "D", "position": [0, 0, -1])",
                       {"bodies[0]: found points and vectors that start as the mirror image"}}});
}

}  // namespace
}  // namespace mbs
