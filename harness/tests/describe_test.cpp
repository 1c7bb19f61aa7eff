// What `mbs describe` says about scenes whose numbers are known.
#include "describe/describe.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "describe/passes.hpp"
#include "describe/recommendation.hpp"
#include "describe/structure.hpp"
#include "reference/reference_simulation.hpp"
#include "registry/setting_names.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "run/stretch.hpp"
#include "scene_file/load_scene.hpp"
#include "support/sample_models.hpp"

namespace mbs {
namespace {

const StepSettings kSettings;  // a step of 1.25e-3 s

Scene scene_of_text(const std::string& json) {
  SceneData data = parse_scene(json, "test");
  return {"test", Model(data.model), {}, {}, data.elements, data.assembly};
}

/// A parallelogram whose coupler's middle N hangs from M too, which changes nothing.
constexpr const char* kRedundant = R"({"points": [
  {"name": "A", "position": [0, 0], "fixed": true}, {"name": "D", "position": [2, 0], "fixed": true},
  {"name": "M", "position": [1, 0], "fixed": true}, {"name": "B", "position": [0.6, 0.8]},
  {"name": "C", "position": [2.6, 0.8]}, {"name": "N", "position": [1.6, 0.8]}],
  "rods": [{"name": "AB", "between": ["A", "B"], "mass": 1},
    {"name": "BC", "between": ["B", "C"], "mass": 1},
    {"name": "DC", "between": ["D", "C"], "mass": 1},
    {"name": "MN", "between": ["M", "N"], "mass": 1}],
  "constraints": [
    {"type": "linear", "name": "middle x", "terms": [{"point": "B", "axis": "x", "coefficient": 1},
      {"point": "C", "axis": "x", "coefficient": 1}, {"point": "N", "axis": "x", "coefficient": -2}]},
    {"type": "linear", "name": "middle y", "terms": [{"point": "B", "axis": "y", "coefficient": 1},
      {"point": "C", "axis": "y", "coefficient": 1}, {"point": "N", "axis": "y", "coefficient": -2}]}
  ]})";

TEST(Describe, FourBar) {
  const auto d = describe_json(load_scene("four-bar:2"), kSettings);
  EXPECT_EQ(d["scene"], "four-bar:2");
  EXPECT_EQ(d["variables"], 6);
  EXPECT_EQ(d["constraints"], 5);
  EXPECT_EQ(d["free_points"], 3);
  EXPECT_EQ(d["fixed_points"], 3);
  EXPECT_EQ(d["jacobian_rank"], 5);
  EXPECT_EQ(d["degrees_of_freedom"], 1);
  EXPECT_EQ(d["degrees_of_freedom_from"], "n - rank");
  EXPECT_EQ(d["mass"]["nonzeros"], 6 + 2 * 4);
  EXPECT_EQ(d["jacobian"]["nonzeros"], 3 * 2 + 2 * 4);
  EXPECT_EQ(d["jacobian"]["fill"], 14.0 / 30.0);
  EXPECT_EQ(d["tangent"]["nonzeros"], 28);
  EXPECT_EQ(d["tangent"]["fill"], 28.0 / 36.0);
  // Three points in a chain, two coordinates each: columns of 4, 3, 4, 3, 2 and 1 non-zeros.
  const nlohmann::json counts = {{"factor_nonzeros", 17}, {"per_column", 17.0 / 6.0},
                                 {"flops", 55.0},         {"height", 6},
                                 {"widest", 4},           {"supernodes", 2}};
  EXPECT_EQ(d["elimination"]["orderings"]["natural"], counts);
  EXPECT_EQ(d["elimination"]["ordering"], "AMD");
  // AMD takes the ends first: the middle two are on every path.
  for (const char* key : {"factor_nonzeros", "flops", "widest"}) {
    EXPECT_EQ(d["elimination"][key], counts[key]) << key;
  }
  EXPECT_EQ(d["elimination"]["height"], 4);
  EXPECT_EQ(d["elimination"]["per_column"], 17.0 / 6.0);
  const nlohmann::json& rows = d["elimination"]["orderings"]["saddle-point"];
  EXPECT_EQ(d["features"],
            nlohmann::json({{"n", 6},
                            {"m", 5},
                            {"jacobian", 14},
                            {"mass", 14},
                            {"tangent", 28},
                            {"fill", 100.0 * (28.0 / 36.0)},
                            {"factor", 17},
                            {"per_column", 17.0 / 6.0},
                            {"flops", 55},
                            {"dense", 100.0 * 55.0 / 91.0},
                            {"height", 4},
                            {"widest", 4},
                            {"supernodes", d["elimination"]["supernodes"]},
                            {"block", 6.0 / d["elimination"]["supernodes"].get<int>()},
                            {"saddle_factor", rows["factor_nonzeros"]},
                            {"saddle_flops", rows["flops"]},
                            {"passes", d["passes"]["penalty"]},
                            {"saddle_passes", d["passes"]["saddle-point"]},
                            {"dimension", 2},
                            {"springs", 0},
                            {"stiff", 0},
                            {"saddle", 0}}));
  EXPECT_EQ(d["scheme"]["take"], "penalty");
  EXPECT_EQ(d["precision"], "double");
  EXPECT_EQ(d["terms"]["gravity"], true);
  EXPECT_EQ(d["terms"]["dot_constraints"], 5);
  EXPECT_EQ(d["terms"]["linear_constraints"], 0);
  EXPECT_EQ(d["terms"]["damping"], false);
  EXPECT_EQ(d["redundant_constraints"], nlohmann::json::array());
  EXPECT_EQ(d["singular_start"], false);
  EXPECT_EQ(d["assembly"]["position_correction"], 0.0);
  EXPECT_EQ(d["judged_length"], 1.0);
  EXPECT_TRUE(d["artificial_fill"].is_null());
}

/// By the reference, over the stretch that is timed.
double counted_passes(const Scene& scene, Scheme scheme) {
  StepSettings settings = kSettings;
  settings.scheme = scheme;
  settings = chosen(scene.model, settings);
  const Stretch stretch =
      make_stretch(scene, settings.step, most_steps(scene.model.variables()), std::nullopt, scheme);
  ReferenceSimulation simulation(scene.model, settings);
  simulation.set_state(stretch.initial);
  int passes = 0;
  for (int step = 0; step < stretch.steps; ++step) passes += simulation.step().passes;
  return static_cast<double>(passes) / stretch.steps;
}

TEST(Describe, PassesAreThoseThatStepsTake) {
  for (const char* name : {"chain:3", "ladder:2", "vehicle:2", "star:3", "four-bar:2"}) {
    const Scene scene = load_scene(name);
    const auto d = recommended(describe_json(scene, kSettings), scene, kSettings, true);
    for (const Scheme scheme : {Scheme::penalty, Scheme::saddle_point}) {
      const char* form = scheme == Scheme::penalty ? "passes" : "saddle_passes";
      EXPECT_NEAR(d["features"][form], counted_passes(scene, scheme), 0.02) << name << ' ' << form;
    }
  }
}

TEST(Describe, StepTimesAreOfThePassesThatWereCounted) {
  const Scene scene = load_scene("chain:3");
  const auto one = [&](bool counts) {
    const auto d = recommended(describe_json(scene, kSettings), scene, kSettings, counts);
    return d["recommendation"][0]["step_us"].get<double>() / d["passes"]["penalty"].get<double>();
  };
  EXPECT_NEAR(one(true), one(false), 1e-9 * one(false));
  const auto before = describe_json(scene, kSettings);
  EXPECT_EQ(before["passes"]["penalty"], kUnknownPasses);
  EXPECT_NE(describe_text(before).find("(assumed, not counted: penalty, saddle-point)"),
            std::string::npos);
  EXPECT_TRUE(recommended(before, scene, kSettings, true)["passes"]["assumed"].empty());
}

TEST(Describe, Text) {
  const std::string text = describe_text(describe_json(load_scene("four-bar:2"), kSettings));
  for (const char* part :
       {"coordinates n         6 (3 free and 3 fixed", "constraints m         5\n",
        "degrees of freedom    1 (n - rank of the Jacobian, 5)\n", "redundant             none\n",
        "start                 regular\n", "assembly              consistent as given\n",
        "terms present         gravity or constant forces (Q), rods (5), quadratic constraints "
        "(5), "
        "fixed points (3)\n",
        "terms absent          constant torques, springs and dampers, torsion springs, "
        "laws of forces and torques, factors of time, stiffness (K), damping (C)",
        "length l              1 m, of the fastest part: ok to an estimated error (--half-step) of "
        "0.01 m, plausible to a sum of local errors of 0.003 m\n",
        "penalty factor        ", "(singular positions) to ", "for step 0.00125 s; automatic ",
        "14 non-zeros, 46.67 % of m n", "28 non-zeros, 77.78 % of n^2",
        "elimination, AMD      17 non-zeros of L, 2.83 a column, 4 at most; 55 operations, 60.4 % "
        "of a full L's; tree of height 4; ",
        "  saddle-point matrix ", "operations, 73.7 % of a dense solver's; "}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nnot in\n" << text;
  }
  EXPECT_EQ(text.find("artificial"), std::string::npos);
}

TEST(Describe, ArtificialFill) {
  const Scene scene = load_scene("four-bar:5,fill=0.50");
  const auto d = describe_json(scene, kSettings);
  EXPECT_EQ(d["artificial_fill"]["asked"], 0.5);
  EXPECT_EQ(d["artificial_fill"]["natural"], 64.0 / 144.0);
  EXPECT_EQ(d["artificial_fill"]["reached"], 0.5);
  EXPECT_EQ(d["artificial_fill"]["seed"], kFillSeed);
  EXPECT_EQ(d["tangent"]["fill"], 0.5);
  EXPECT_NE(describe_text(d).find("asked 50 %, natural 44.44 %, reached 50 %, seed 607615"),
            std::string::npos);
}

TEST(Describe, LargeScenesHaveTheirRank) {
  const auto d = describe_json(load_scene("four-bar:9999"), kSettings);  // 20 000 coordinates
  EXPECT_EQ(d["jacobian_rank"], 19'999);
  EXPECT_EQ(d["degrees_of_freedom"], 1);
  EXPECT_EQ(d["singular_start"], false);
}

TEST(Describe, NamesRedundantConstraints) {
  const Scene scene = scene_of_text(kRedundant);
  const auto d = describe_json(scene, kSettings);
  EXPECT_EQ(d["variables"], 6);
  EXPECT_EQ(d["constraints"], 6);
  EXPECT_EQ(d["jacobian_rank"], 5);
  EXPECT_EQ(d["degrees_of_freedom"], 1);
  ASSERT_EQ(d["redundant_constraints"].size(), 1u);
  EXPECT_NE(d["redundant_constraints"][0].get<std::string>().find("middle y"), std::string::npos)
      << d["redundant_constraints"];
  EXPECT_EQ(d["singular_start"], false);
  EXPECT_NE(describe_text(d).find("redundant             1, implied by those before"),
            std::string::npos);
  // Redundancy does not stretch the window down to nothing.
  EXPECT_LT(d["penalty_window"]["lower"], d["penalty_window"]["upper"]);
}

TEST(Describe, TellsASingularStartFromRedundancy) {
  const Model straight = [] {  // a parallelogram that starts with all its rods on one line
    ModelData data = four_bar(2);
    for (std::size_t i = 0; i < 3; ++i) data.points[3 + i].position = {i + 1.0, 0.0, 0.0};
    std::ranges::fill(data.initial_velocity, 0.0);
    return Model(std::move(data));
  }();
  const Structure structure = find_structure(straight);
  EXPECT_EQ(structure.rank_at_start, 3);
  EXPECT_EQ(structure.rank, 5);
  EXPECT_EQ(structure.singular, true);
  EXPECT_TRUE(structure.redundant.empty());
  EXPECT_EQ(structure.singular_rows.size(), 2u);
  const Scene scene{"test", straight, {}, {}};
  const auto d = describe_json(scene, kSettings);
  EXPECT_EQ(d["degrees_of_freedom"], 1);
  EXPECT_EQ(d["singular_start"]["rank"], 3);
  EXPECT_EQ(d["singular_start"]["constraints"].size(), 2u);
  EXPECT_NE(describe_text(d).find("start                 singular, rank 3 only: "),
            std::string::npos);
}

TEST(Describe, RankShowsDegreesOfFreedomThatCountingMisses) {
  // Two points on one rail each, and a third constraint that follows from the rails.
  const Scene scene = scene_of_text(R"({"gravity": [0, 0], "points": [
      {"name": "B", "position": [0, 1]}, {"name": "C", "position": [2, 1]}],
      "masses": [{"point": "B", "mass": 1}, {"point": "C", "mass": 1}],
      "constraints": [{"type": "linear", "terms": [{"point": "B", "axis": "y", "coefficient": 1}]},
                      {"type": "linear", "terms": [{"point": "C", "axis": "y", "coefficient": 1}]},
                      {"type": "linear", "terms": [{"point": "B", "axis": "y", "coefficient": 1},
                                                   {"point": "C", "axis": "y", "coefficient": 1}]}
      ]})");
  const auto d = describe_json(scene, kSettings);
  EXPECT_EQ(d["constraints"], 3);
  EXPECT_EQ(d["degrees_of_freedom"], 2);
  EXPECT_EQ(d["terms"]["gravity"], false);
  EXPECT_EQ(d["terms"]["linear_constraints"], 3);
  EXPECT_NE(describe_text(d).find("terms absent          gravity or constant forces"),
            std::string::npos);
}

TEST(Describe, SaysWhatAssemblyMoved) {
  const Scene scene = scene_of_text(R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
      {"name": "B", "position": [1.01, 0], "velocity": [0, 2]}],
      "rods": [{"between": ["A", "B"], "mass": 1, "length": 1}]})");
  const auto d = describe_json(scene, kSettings);
  EXPECT_NEAR(d["assembly"]["position_correction"].get<double>(), 0.01, 1e-12);
  EXPECT_EQ(d["assembly"]["velocity_correction"], 0.0);
  EXPECT_EQ(d["assembly"]["point"], "B");
  EXPECT_NE(describe_text(d).find("points moved by up to 0.01 m (B)\n"), std::string::npos);
}

TEST(Describe, TakesTheSaddlePointFormWhereNoPenaltyFactorSuitsTheStep) {
  const auto d =
      describe_json(load_scene("four-bar:40"), {.precision = Precision::single_precision});
  EXPECT_EQ(d["scheme"]["take"], "saddle-point");
  EXPECT_EQ(d["scheme"]["reason"],
            "saddle-point form, as no penalty factor is expected to do at step 0.00125 s");
}

TEST(Describe, CountsTerms) {
  ModelData data;
  data.points = {{"A", -1, {0, 0, 0}}, {"B", 0, {1, 0, 0}}, {"C", 2, {1, 1, 0}}};
  for (int i = 0; i < 4; ++i) data.mass.push_back({i, i, 1.0});
  data.force.resize(4, 0.0);
  data.initial_velocity.resize(4, 0.0);
  data.bilinear_constraints.push_back({1, 0, 2, 0, {{{0, 1, 0}, {-1, 0, 0}, {}}}, 1.0, "cross"});
  data.springs.push_back({0, 1, 0.0, 5.0, 1.0, "damper"});
  data.torsion_springs.push_back({1, 0, 2, 0, -1, 3.0, 0.0, 0.0, "torsion"});
  data.couples.push_back({1, 0, -1, 2.0, "motor"});
  data.driven_points.push_back({0, {}});
  const Scene scene{"test", Model(data), {}, {}};
  const auto d = describe_json(scene, kSettings);
  EXPECT_EQ(d["features"]["springs"], 2);
  const auto& terms = d["terms"];
  EXPECT_EQ(terms["bilinear_constraints"], 1);
  EXPECT_EQ(terms["springs"], 1);
  EXPECT_EQ(terms["torsion_springs"], 1);
  EXPECT_EQ(terms["couples"], 1);
  EXPECT_EQ(terms["damping"], true);
  EXPECT_EQ(terms["stiffness"], true);
  EXPECT_EQ(terms["driven_points"], 1);
  EXPECT_EQ(terms["fixed_points"], 0);
  EXPECT_EQ(terms["driven_constraints"], true);
  EXPECT_EQ(terms["gravity"], false);
}

TEST(Describe, ListsElementsForPictures) {
  Scene scene = test::spatial_pendulum();
  scene.elements.bodies.push_back({"body", {0, 1, 4}, {2}});
  scene.elements.markers.push_back({"middle",
                                    {{0, {{{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}}},
                                     {1, {{{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}}}}});
  const auto elements = describe_json(scene, kSettings)["elements"];
  ASSERT_EQ(elements["points"].size(), 5u);
  EXPECT_EQ(elements["points"][0]["kind"], "fixed");
  EXPECT_EQ(elements["points"][1]["kind"], "free");
  EXPECT_EQ(elements["points"][3]["position"], nlohmann::json({1.0, 2.0, -0.5}));
  EXPECT_EQ(elements["points"][4]["kind"], "marker");
  EXPECT_EQ(elements["points"][4]["position"], nlohmann::json({0.5, 0.0, 0.0}));
  EXPECT_EQ(elements["bodies"][0]["points"], nlohmann::json({"A", "B", "middle"}));
  EXPECT_EQ(elements["bodies"][0]["vectors"], nlohmann::json::array({"C"}));
  EXPECT_TRUE(elements["rods"].empty());
  const auto four_bar = describe_json(load_scene("four-bar:1"), kSettings)["elements"];
  ASSERT_EQ(four_bar["rods"].size(), 3u);
  EXPECT_EQ(four_bar["rods"][2]["between"], nlohmann::json::array({"B0", "B1"}));
}

TEST(Describe, ListsDistancesBesideBodiesAndMarksHelpers) {
  const auto d = describe_json(scene_of_text(R"({"points": [
      {"name": "A", "position": [0, 0], "fixed": true},
      {"name": "D", "position": [3, 0],
       "driven": {"x": {"table": {"times": [0, 1, 2, 3, 4], "values": [3, 3, 3, 3, 3]}}}}],
    "bodies": [{"name": "L", "mass": 2, "inertia": 0.2, "points": {"A": [0, 0], "B": [1, 0]},
                "pose": {"angle": 0.3}},
               {"name": "K", "mass": 2, "inertia": 0.2, "points": {"C": [0, 0]},
                "pose": {"position": [3, 1]}}],
    "constraints": [{"name": "rope", "type": "distance", "between": ["B", "C"]},
                    {"type": "distance", "between": ["D", "C"]}]})"),
                               kSettings);
  EXPECT_EQ(d["drivers_end"], 4.0);
  const auto& elements = d["elements"];
  ASSERT_EQ(elements["distances"].size(), 2u);
  EXPECT_EQ(elements["distances"][0]["name"], "rope");
  EXPECT_EQ(elements["distances"][0]["between"], nlohmann::json::array({"B", "C"}));
  EXPECT_TRUE(elements["rods"].empty());
  EXPECT_EQ(d["fixed_points"], 1);
  EXPECT_EQ(d["driven_points"], 1);
  int helpers = 0;
  for (const auto& point : elements["points"]) {
    const std::string name = point["name"];
    EXPECT_EQ(point["helper"].get<bool>(), name.size() > 1) << name;
    helpers += point["helper"].get<bool>();
  }
  EXPECT_GT(helpers, 0);
}

TEST(Describe, DriversOfFunctionsNeverEnd) {
  EXPECT_TRUE(describe_json(load_scene("four-bar:2"), kSettings)["drivers_end"].is_null());
}

TEST(Describe, DriversTooFastForTheStepAreDescribed) {
  const auto d = describe_json(scene_of_text(R"({"points": [
      {"name": "A", "driven": {"x": {"sine": {"amplitude": 1e-3, "frequency": 1000}}, "y": 0}},
      {"name": "B", "position": [0, -1]}],
    "rods": [{"between": ["A", "B"], "mass": 1}]})"),
                               kSettings);
  EXPECT_EQ(d["degrees_of_freedom"], 1);
  EXPECT_GE(d["passes"]["penalty"], 1.0);
}

TEST(Describe, FreeFlightHasNoConstraints) {
  const Scene scene = test::free_fall();
  const auto d = describe_json(scene, kSettings);
  EXPECT_EQ(d["constraints"], 0);
  EXPECT_EQ(d["degrees_of_freedom"], 4);
  EXPECT_EQ(d["jacobian"]["fill"], 0.0);
  EXPECT_TRUE(d["penalty_window"].is_null());
  EXPECT_EQ(d["scheme"]["take"], "penalty");
  EXPECT_NE(describe_text(d).find("any, there are no constraints"), std::string::npos);
}

}  // namespace
}  // namespace mbs
