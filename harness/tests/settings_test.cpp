// The automatic rules for penalty and tolerance against their documented formulas, and bad values.
#include "run/settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "run/initial_state.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"
#include "support/dense.hpp"
#include "support/sample_models.hpp"
#include "support/scene_support.hpp"

namespace mbs {
namespace {

constexpr double kStep = 1.25e-3;

struct Spectrum {
  double smallest, mean, least;  ///< s_min (above 0), s_mean, s_row of automatic_penalty()
};

Spectrum spectrum_of(const Model& model) {
  const Eigen::MatrixXd Phi_q = test::dense_jacobian(model, model.initial_position());
  const Eigen::MatrixXd lumped = test::dense_mass(model).diagonal().asDiagonal().inverse();
  const Eigen::VectorXd values =
      test::eigenvalues(test::dense_constraint_matrix(model, model.initial_position()));
  Eigen::Index first = 0;
  while (values[first] < 1e-12 * values.maxCoeff()) ++first;
  const Eigen::VectorXd rows = (Phi_q * lumped * Phi_q.transpose()).diagonal();
  return {values[first], rows.mean(), rows.minCoeff()};
}

/// beta of the documented rule, at omega = sqrt(2 * 1.5 g / 1 m), the rate of the N-four-bar.
double documented_beta(const Spectrum& s, double step,
                       Precision precision = Precision::double_precision) {
  const double measured = std::clamp(30 / s.smallest, 4e3 / s.mean, 1e7 / s.mean);
  const bool single = precision == Precision::single_precision;
  const double turn = std::sqrt(3 * 9.81) * step, x = turn / (single ? 13.6e-3 : 6.8e-3);
  if (x <= 1)
    return std::min(measured / (x * x), std::max(measured, (single ? 6e4 : 4e6) / s.mean));
  const double longer = std::min(measured, 0.6 / (s.least * turn * turn * turn));
  return std::max(longer, measured / 100);
}

TEST(AutomaticPenalty, WithKeptTangentsOrInFloatIsTheDocumentedRule) {
  bool lower = false, middle = false;
  for (const int loops : {1, 10, 40, 60}) {
    const Model model(four_bar(loops));
    const Spectrum s = spectrum_of(model);
    for (const double step : {2e-5, 1e-3, kStep, 1e-2, 1e-1}) {
      for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
        const double rule = 4 / (step * step) * documented_beta(s, step, precision);
        EXPECT_NEAR(
            automatic_penalty(
                model, {.step = step, .tangent = TangentReuse::kept, .precision = precision}),
            rule, 0.05 * rule)
            << loops << " " << step;
      }
    }
    (30 / s.smallest > 4e3 / s.mean ? middle : lower) = true;
  }
  EXPECT_TRUE(lower && middle);  // both parts of the rule were met
}

TEST(AutomaticPenalty, IsTheDocumentedRuleInBothForms) {
  bool lower = false, middle = false;
  for (const int loops : {1, 10, 60}) {
    const Model model(four_bar(loops));
    const Spectrum s = spectrum_of(model);
    for (const double step : {2e-5, 2e-4, kStep, 1e-2}) {
      const double x = std::sqrt(3 * 9.81) * step / 6.8e-3, wanted = 15 / (s.smallest * x * x);
      for (const Scheme scheme : {Scheme::saddle_point, Scheme::penalty}) {
        const bool is_penalty = scheme == Scheme::penalty;
        const double least = (is_penalty ? 1e6 : 2.5e7) / s.mean;
        const double most = 1e10 / (is_penalty ? s.least : s.mean);
        const double rule = 4 / (step * step) * std::clamp(wanted, least, most);
        EXPECT_NEAR(automatic_penalty(model, {.step = step, .scheme = scheme}), rule, 0.05 * rule)
            << loops << " " << step;
      }
      (wanted > 2.5e7 / s.mean ? middle : lower) = true;
    }
  }
  EXPECT_TRUE(lower && middle);  // both parts of the rule were met
}

TEST(AutomaticPenalty, IsThatOfTheIndependentConstraintsWhereSomeAreRedundant) {
  ModelData data = four_bar(40);
  data.dot_constraints.push_back(data.dot_constraints[0]);
  const Model model(std::move(data));
  const Spectrum s = spectrum_of(model);
  constexpr double kShort = 1e-5;
  const double x = std::sqrt(3 * 9.81) * kShort / 6.8e-3;
  const double beta = 15 / (s.smallest * x * x);  // the slowest mode decides
  EXPECT_GT(beta, 1e6 / s.mean);
  EXPECT_LT(beta, 1e10 / s.mean);
  const double rule = 4 / (kShort * kShort) * beta;
  EXPECT_NEAR(automatic_penalty(model, {.step = kShort}), rule, 0.05 * rule);
}

TEST(AutomaticPenalty, IsAsIfASingularStartWereRegular) {
  ModelData data = four_bar(2);
  for (std::size_t i = 0; i < 3; ++i) data.points[3 + i].position = {i + 1.0, 0.0, 0.0};
  std::ranges::fill(data.initial_velocity, 0.0);
  const Model model(std::move(data));
  const double step = 6.8e-3 / std::sqrt(3 * 9.81),
               lower = 4 / (step * step) * 1e6 / spectrum_of(model).mean;
  EXPECT_NEAR(automatic_penalty(model, {.step = step}), lower, 1e-6 * lower);
}

TEST(AutomaticPenalty, MakesAStepOfOnePassDampTheSlowestModeOfLongMechanisms) {
  for (const auto& [name, scheme] : {std::pair{"scissors:600", Scheme::penalty},
                                     {"scissors:1000", Scheme::penalty},
                                     {"scissors:300", Scheme::saddle_point}}) {
    const Model model = load_scene(name).model;
    const double smallest = smallest_constraint_eigenvalue(model, model.initial_position());
    const double stable = 4 / (kStep * kStep) * 2 / smallest;
    EXPECT_NEAR(automatic_penalty(model, {.step = kStep, .scheme = scheme}), stable, 1e-6 * stable)
        << name;
  }
}

TEST(AutomaticPenalty, LeavesAModeThatIsSlowOnlyAtTheStart) {
  // Bars that hold one another nearly level.
  ModelData data = four_bar(2);
  for (std::size_t i = 0; i < 3; ++i) data.points[3 + i].position = {i + 1.0, 1e-7, 0.0};
  std::ranges::fill(data.initial_velocity, 0.0);
  const Model model(std::move(data));
  const double most = 4 / (kStep * kStep) * 2e10 / mean_constraint_eigenvalue(model);
  EXPECT_LT(automatic_penalty(model, {.step = kStep}), 1.1 * most);
}

TEST(AutomaticPenalty, IsOneWithoutConstraints) {
  EXPECT_EQ(automatic_penalty(test::free_fall().model, {.step = kStep}), 1.0);
}

TEST(AutomaticTolerance, IsTheDocumentedRule) {
  const Model model(four_bar(10));
  EXPECT_DOUBLE_EQ(automatic_tolerance(model, {.step = kStep, .penalty = 1e9}), 1e-9);
  EXPECT_DOUBLE_EQ(automatic_tolerance(model, {.step = 2 * kStep, .penalty = 1e9}), 16e-9);
  const double penalty = automatic_penalty(model, {.step = kStep});  // Newton's passes
  EXPECT_DOUBLE_EQ(automatic_tolerance(model, {.step = kStep, .penalty = penalty}), 1e-8);
  EXPECT_DOUBLE_EQ(automatic_tolerance(model, {.step = 1.0, .penalty = 1.0}), 1e-6);
  const double unit = std::ldexp(1.0, -53), step = 1e-5, alpha = 1e12;
  const double noise =
      10 * unit * 10.0 * std::sqrt(1 + alpha * step * step / 4 * spectrum_of(model).mean);
  EXPECT_GT(noise, 1e-9 * std::pow(step / kStep, 4));
  EXPECT_NEAR(automatic_tolerance(model, {.step = step, .penalty = alpha}), noise, 1e-9 * noise);
}

TEST(AutomaticTolerance, OfTheSaddlePointFormIsLooserWhereItConvergesQuadratically) {
  const Model model(four_bar(10));
  StepSettings settings{.step = kStep, .penalty = 1e10, .scheme = Scheme::saddle_point};
  EXPECT_DOUBLE_EQ(automatic_tolerance(model, settings), 1e-8);
  settings.tangent = TangentReuse::kept;
  EXPECT_DOUBLE_EQ(automatic_tolerance(model, settings), 1e-9);
  settings = {.step = 2 * kStep, .penalty = 1e10, .scheme = Scheme::saddle_point};
  EXPECT_DOUBLE_EQ(automatic_tolerance(model, settings), 4e-8);
}

TEST(AutomaticTolerance, IsTighterWhereAStiffDamperTurnsErrorsRound) {
  const double limit = 2 * 3.0 / kStep;  // N s/m, for 3 kg
  for (const auto& [damping, expected] : {std::pair{0.99 * limit, 1e-8}, {1.01 * limit, 1e-9}}) {
    ModelData data;
    data.points = {{"A", -1, {0, 0, 0}}, {"B", 0, {1, 0, 0}}, {"C", -1, {1, 1, 0}}};
    data.mass = {{0, 0, 3.0}, {1, 1, 3.0}};
    data.force = {0.0, -30.0};
    data.initial_velocity = {0.0, 0.0};
    data.dot_constraints = {{0, 1, 0, 1, 1.0, "rod"}};
    data.springs = {{1, 2, 0.0, damping, 1.0, "damper"}};
    const Model model(std::move(data));
    const StepSettings settings{.step = kStep, .penalty = 1e9, .scheme = Scheme::saddle_point};
    EXPECT_DOUBLE_EQ(automatic_tolerance(model, settings), expected);
  }
}

TEST(AutomaticTolerance, FarFromTheOriginIsTheRoundingOfCoordinates) {
  ModelData data;
  data.points = {{"A", -1, {1e6, 0, 0}}, {"B", 0, {1e6 + 1, 0, 0}}};
  data.mass = {{0, 0, 1.0}, {1, 1, 1.0}};
  data.force = data.initial_velocity = {0.0, 0.0};
  data.dot_constraints = {{0, 1, 0, 1, 1.0, "rod"}};
  const Model model(std::move(data));
  EXPECT_EQ(rounding_length(model), 1.0);
  EXPECT_NEAR(automatic_tolerance(model, {.step = kStep, .penalty = 1e9}),
              10 * std::ldexp(1.0, -53) * 1e6, 1e-14);
}

TEST(AutomaticTolerance, IsInProportionToAShortRod) {
  ModelData data;
  data.points = {{"A", -1, {0, 0, 0}}, {"B", 0, {1e-3, 0, 0}}};
  data.mass = {{0, 0, 1.0}, {1, 1, 1.0}};
  data.force = {0.0, -1e-2};
  data.initial_velocity = {0.0, 0.0};
  data.dot_constraints = {{0, 1, 0, 1, 1e-6, "rod"}};
  EXPECT_DOUBLE_EQ(automatic_tolerance(Model(std::move(data)), {.step = kStep, .penalty = 1e9}),
                   1e-12);
}

TEST(AutomaticTolerance, WithoutConstraints) {
  EXPECT_DOUBLE_EQ(automatic_tolerance(test::free_fall().model, {.step = kStep, .penalty = 1.0}),
                   1e-9);
}

TEST(ParseAutomatic, TakesNumbersAndAuto) {
  EXPECT_EQ(parse_automatic("--penalty", "1e8"), 1e8);
  EXPECT_EQ(parse_automatic("--penalty", "0.5"), 0.5);
  EXPECT_EQ(parse_automatic("--penalty", "123456"), 123456.0);
  EXPECT_EQ(parse_automatic("--penalty", "auto"), 0.0);
}

TEST(ParseAutomatic, RefusesEverythingElse) {
  for (const char* text :
       {"",     " ",     "auto ",  "Auto", "0",    "-0",   "-1",  "nan",  "-nan", "inf",
        "-inf", "1e400", "1e-400", "1e8x", " 1e8", "1e8 ", "1,5", "0x10", "--",   "e8"}) {
    try {
      parse_automatic("--penalty", text);
      ADD_FAILURE() << '"' << text << "\" was taken";
    } catch (const UsageError& error) {
      expect_parts(error.what(), {"--penalty", std::string("'") + text + "'", "'auto'", "above 0"});
    }
  }
}

TEST(Chosen, IsWhatIsZero) {
  const Model model(four_bar(2));
  const StepSettings both = chosen(model, {.step = kStep});
  EXPECT_EQ(both.penalty, automatic_penalty(model, {.step = kStep}));
  EXPECT_EQ(both.tolerance, automatic_tolerance(model, both));
  const StepSettings one = chosen(model, {.step = kStep, .penalty = 3e7});
  EXPECT_EQ(one.penalty, 3e7);
  EXPECT_EQ(one.tolerance, automatic_tolerance(model, {.step = kStep, .penalty = 3e7}));
  EXPECT_EQ(chosen(model, {.step = kStep, .tolerance = 1e-5}).tolerance, 1e-5);
}

TEST(Chosen, RefusesAPenaltyFactorThatIsNoNumber) {
  ModelData data;  // a rod of 1e-130 m with 1e50 kg at its end
  data.points = {{"A", -1, {0, 0, 0}}, {"B", 0, {1e-130, 0, 0}}};
  data.mass = {{0, 0, 1e50}, {1, 1, 1e50}};
  data.force = data.initial_velocity = {0.0, 0.0};
  data.dot_constraints.push_back({1, 0, 1, 0, 1e-260, "rod"});
  EXPECT_THROW(chosen(Model(std::move(data)), {.step = kStep}), UsageError);
}

}  // namespace
}  // namespace mbs
