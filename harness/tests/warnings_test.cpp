// Warnings about settings, and the window of the penalty factor, against what was measured.
#include "describe/warnings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>

#include "describe/describe.hpp"
#include "describe/penalty_window.hpp"
#include "describe/structure.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/sample_models.hpp"

namespace mbs {
namespace {

TEST(Warnings, TellOfPenaltyFactorsFarOutsideTheWindow) {
  const Model model(four_bar(3));
  StepSettings settings{.penalty = 1e8};
  EXPECT_TRUE(setting_warnings(model, settings, PenaltyFrom::user).empty());
  for (const auto& [penalty, word] : {std::pair{1e-300, "far below"}, {1e20, "far above"}}) {
    settings.penalty = penalty;
    const auto warnings = setting_warnings(model, settings, PenaltyFrom::user);
    ASSERT_EQ(warnings.size(), 1u) << penalty;
    EXPECT_NE(warnings[0].find(word), std::string::npos) << warnings[0];
  }
  EXPECT_TRUE(describe_json(load_scene("four-bar:40"), {})["warnings"].empty());
}

TEST(Warnings, NeverBlameThePenaltyFactorOfTheRule) {
  const Model model(four_bar(10));
  const struct {
    double step;
    Precision precision;
    std::string words;
  } cases[] = {
      {5e-2, Precision::single_precision, "0.05 s is too long"},
      {5e-2, Precision::single_precision, "or a shorter step"},
      {1e-6, Precision::single_precision, "1e-06 s is too short"},
      {1e-6, Precision::single_precision, "saddle-point, --precision double, or a longer step"},
  };
  for (const auto& [step, precision, words] : cases) {
    StepSettings settings{.step = step};
    settings.precision = precision;
    settings.penalty = automatic_penalty(model, settings);
    const auto warnings = setting_warnings(model, settings, PenaltyFrom::rule);
    ASSERT_EQ(warnings.size(), 1u) << step;
    EXPECT_NE(warnings[0].find(words), std::string::npos) << warnings[0];
    EXPECT_EQ(warnings[0].find("penalty factor"), std::string::npos) << warnings[0];
  }
}

TEST(Warnings, SendToNoOtherStepWhereNoneSuits) {
  for (const double step : {1e-2, 1.25e-3, 1e-4}) {
    const Model model(four_bar(4000));
    StepSettings settings{.step = step, .precision = Precision::single_precision};
    settings.penalty = automatic_penalty(model, settings);
    const auto warnings = setting_warnings(model, settings, PenaltyFrom::rule);
    ASSERT_EQ(warnings.size(), 1u) << step;
    EXPECT_TRUE(warnings[0].starts_with("no step suits")) << warnings[0];
    settings.precision = Precision::double_precision;
    settings.penalty = automatic_penalty(model, settings);
    EXPECT_TRUE(setting_warnings(model, settings, PenaltyFrom::rule).empty());
  }
}

TEST(Warnings, SayWhereNoPenaltyFactorSuits) {
  ModelData data = four_bar(2);  // bars that hold one another nearly level
  for (std::size_t i = 0; i < 3; ++i) data.points[3 + i].position = {i + 1.0, 1e-8, 0.0};
  std::ranges::fill(data.initial_velocity, 0.0);
  const Model model(std::move(data));
  StepSettings settings;
  settings.penalty = automatic_penalty(model, settings);
  const auto warnings = setting_warnings(model, settings, PenaltyFrom::rule);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].starts_with("no penalty factor")) << warnings[0];
}

TEST(Warnings, TellOfALooseTolerance) {
  const Model model = load_scene("four-bar:2").model;
  StepSettings settings;
  settings.penalty = automatic_penalty(model, settings);
  const double automatic = automatic_tolerance(model, settings);
  settings.tolerance = 0.9 * kLoosest * automatic;
  EXPECT_EQ(tolerance_warning(model, settings), "");
  settings.tolerance = 1.1 * kLoosest * automatic;
  EXPECT_NE(tolerance_warning(model, settings).find("tolerance"), std::string::npos);
}

TEST(Warnings, TellOfSingularStarts) {
  const auto warnings = [](const char* text) {
    StepSettings settings;
    const Model model(parse_scene(text, "test.json").model);
    settings.penalty = automatic_penalty(model, settings);
    std::string all;
    for (const std::string& warning : setting_warnings(model, settings, PenaltyFrom::rule)) {
      all += warning + "\n";
    }
    return all;
  };
  EXPECT_NE(warnings(R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
      {"name": "B", "position": [1, 0]}, {"name": "C", "position": [2, 0]},
      {"name": "D", "position": [3, 0], "fixed": true}],
    "rods": [{"between": ["A", "B"], "mass": 1}, {"name": "last", "between": ["B", "C"], "mass": 1},
             {"between": ["C", "D"], "mass": 1}]})")
                .find("singular position"),
            std::string::npos);
  EXPECT_EQ(warnings(R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
      {"name": "B", "position": [1, 0]}], "rods": [{"between": ["A", "B"], "mass": 1}]})"),
            "");
}

/// On 1e4 N/m; `damping` in N s/m.
Model oscillating(double damping) { return test::oscillator(1e4, damping, 1.0, 1.0).model; }

TEST(Warnings, TellOfStepsTooLongForSprings) {
  EXPECT_NEAR(shortest_period(oscillating(0.0)), 2 * std::numbers::pi / 100, 1e-15);
  EXPECT_EQ(period_warning(oscillating(0.0), 6e-3), "");
  EXPECT_NE(period_warning(oscillating(0.0), 7e-3).find("shortest period"), std::string::npos);
  EXPECT_EQ(period_warning(oscillating(200.1), 7e-3), "");  // creeps back
  EXPECT_EQ(period_warning(Model(four_bar(2)), 1.0), "");
  const SceneData driven =
      parse_scene(R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
      {"name": "B", "position": [1, 0]}], "masses": [{"point": "B", "mass": 1}],
    "springs": [{"between": ["A", "B"], "length": 1, "stiffness": {"polynomial": [1e4, 1]}}]})",
                  "test");
  EXPECT_NEAR(shortest_period(Model(driven.model)), 2 * std::numbers::pi / 100, 1e-15);
  ModelData data;  // a rod of 2 m, 3 kg at its end, on 12 N m/rad
  data.points = {{"A", -1, {0, 0, 0}}, {"X", -1, {1, 0, 0}}, {"B", 0, {0, 2, 0}}};
  data.mass = {{0, 0, 3.0}, {1, 1, 3.0}};
  data.force = data.initial_velocity = {0.0, 0.0};
  data.torsion_springs.push_back({1, 0, 2, 0, -1, 12.0, 0.0, 1.5, "torsion"});
  EXPECT_NEAR(shortest_period(Model(std::move(data))), 2 * std::numbers::pi, 1e-14);
}

PenaltyWindow window_of(const Model& model, const StepSettings& settings) {
  return penalty_window(model, find_structure(model),
                        smallest_constraint_eigenvalue(model, model.initial_position()), settings);
}

// The window against what was measured over 5 s.
TEST(PenaltyWindow, IsWhereRunsAreGood) {
  const struct {
    int loops;
    double step, good_from, good_to;  // alpha dt^2/4 with an error of at most twice the best
  } cases[] = {{2, 5e-3, 14, 1.4e13},      {2, 1.25e-3, 78, 7.8e11},   {10, 5e-3, 16, 2.8e12},
               {10, 1.25e-3, 89, 2.8e12},  {40, 2.5e-3, 93, 2.9e12},   {40, 1.25e-3, 290, 9.3e11},
               {40, 6.25e-4, 1.6e3, 3e10}, {10, 6.25e-4, 500, 2.8e11}, {10, 1e-4, 1.6e4, 5e9},
               {40, 1e-4, 5.2e4, 5e9}};
  for (const auto& [loops, step, good_from, good_to] : cases) {
    const Model model(four_bar(loops));
    const PenaltyWindow window = window_of(model, {.step = step});
    const double per_beta = 4.0 / (step * step);
    EXPECT_LE(window.lower, window.upper) << loops << ", " << step;
    for (const auto& [bound, measured] :
         {std::pair(window.lower, good_from), std::pair(window.upper, good_to)}) {
      EXPECT_LT(std::abs(std::log10(bound / (per_beta * measured))), std::log10(12.0))
          << loops << ", " << step << ": " << bound / per_beta << " against " << measured;
    }
  }
}

/// What mbs says of the forces of a square's rods and an angle at its corner.
std::string said_of_square(
    const std::string& rods, const std::string& constraints = "",
    const std::string& outputs = R"({"name": "pull", "constraint_force": "OA"})") {
  return force_warning(scene_of(
      nlohmann::json::parse(R"({"points": [{"name": "O", "position": [0, 0], "fixed": true},
      {"name": "A", "position": [1, 0]}, {"name": "B", "position": [1, 1]}, {"name": "C", "position": [0, 1]}],
    "rods": [{"name": "OA", "between": ["O", "A"], "mass": 1}, {"name": "AB", "between": ["A", "B"], "mass": 1},
      {"name": "BC", "between": ["B", "C"], "mass": 1}, {"name": "CO", "between": ["C", "O"], "mass": 1})" +
                            rods + R"(], "constraints": [)" + constraints + R"(], "outputs": [)" +
                            outputs + "]}"),
      "test"));
}

TEST(Warnings, TellOfForcesThatConstraintsLeaveOpen) {
  const std::string one = R"(, {"between": ["O", "B"], "mass": 1})";
  EXPECT_EQ(said_of_square(one), "");
  EXPECT_NE(
      said_of_square(one + R"(, {"between": ["A", "C"], "mass": 1})").find("outputs \"pull\":"),
      std::string::npos);
  std::string all;
  for (const char* rod : {"OA", "AB", "BC", "CO"}) {
    all += (all.empty() ? "" : ", ") + std::string(R"({"name": ")") + rod +
           R"(", "constraint_force": ")" + rod + R"("})";
  }
  EXPECT_TRUE(said_of_square(one + R"(, {"between": ["A", "C"], "mass": 1})", "", all)
                  .starts_with(R"(outputs "OA", "AB", "BC", and others: )"));
  // Of the two rows of a driven angle one depends on the other and on the rods: what they do does
  // not.
  EXPECT_EQ(said_of_square("", R"({"type": "angle", "first": ["O", "A"], "second": ["A", "B"],
                                   "value": {"polynomial": [1.5707963267948966, 0.1]}})"),
            "");
}

// In single precision, against measured maps: what of beta (decades) is ok, where any is.
TEST(PenaltyWindow, OfSinglePrecisionIsWhereRunsAreGood) {
  const struct {
    int loops;
    double step, good_from, good_to;
  } cases[] = {{1, 1.25e-3, 1e2, 1e4}, {1, 6.25e-4, 1e3, 1e4}, {10, 1.25e-3, 1e3, 1e4},
               {10, 2.5e-3, 1e2, 1e4}, {20, 2.5e-3, 1e2, 1e4}, {20, 1.25e-3, 3e3, 1e4}};
  for (const auto& [loops, step, good_from, good_to] : cases) {
    const Model model(four_bar(loops));
    const PenaltyWindow window =
        window_of(model, {.step = step, .precision = Precision::single_precision});
    const double per_beta = 4.0 / (step * step);
    EXPECT_GT(window.upper, kClosedBySlowestInSingle * window.lower) << loops << ", " << step;
    EXPECT_LT(std::abs(std::log10(window.lower / (per_beta * good_from))), 1.0)
        << loops << ", " << step << ": " << window.lower / per_beta;
    EXPECT_LT(std::abs(std::log10(window.upper / (per_beta * good_to))), 1.0)
        << loops << ", " << step << ": " << window.upper / per_beta;
  }
  for (const auto& [loops, step] :
       {std::pair(10, 3.125e-4), std::pair(5, 3.125e-4), std::pair(20, 6.25e-4),
        std::pair(40, 1.25e-3), std::pair(200, 1.25e-3)}) {
    const Model model(four_bar(loops));
    const StepSettings settings{.step = step, .precision = Precision::single_precision};
    const PenaltyWindow window = window_of(model, settings);
    EXPECT_LT(window.upper, kClosedBySlowestInSingle * window.lower) << loops << ", " << step;
    const std::string warning = penalty_warning(window, settings, PenaltyFrom::rule);
    EXPECT_NE(warning.find("saddle-point, --precision double"), std::string::npos) << warning;
  }
}

TEST(PenaltyWindow, IsEmptyWhereNoPenaltyWorks) {
  const Model model = load_scene("scissors:2000").model;
  const PenaltyWindow window = window_of(model, {});
  EXPECT_GT(window.lower, window.upper);
  EXPECT_TRUE(window.cancellation);
  EXPECT_TRUE(window.slowest_mode);
}

}  // namespace
}  // namespace mbs
