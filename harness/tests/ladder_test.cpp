// `mbs check --ladder` and `mbs reference`: planted mistakes are named, sound implementations go
// up, and the reference's numbers are those of the equations.
#include "ladder/ladder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "model_math/kinematics.hpp"
#include "registry/factory.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "support/gtest_name.hpp"
#include "support/program.hpp"
#include "support/term_models.hpp"

namespace mbs {
namespace {

using nlohmann::json;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// What climbs up and where it stops.
struct Fall {
  const char* variant;
  const char* rung;
  const char* row;      ///< part of it
  const char* detail;   ///< what is said of the quantity, or of the child
  const char* mistake;  ///< part of a usual one
};
void PrintTo(const Fall& fall, std::ostream* out) { *out << fall.variant; }

class PlantedMistake : public ::testing::TestWithParam<Fall> {};

TEST_P(PlantedMistake, IsNamedByTheFirstRungThatFails) {
  const Fall& fall = GetParam();
  const std::string file = test::temporary_path("ladder.json");
  const bool hangs = std::string(fall.variant) == "control/hangs";
  const auto run = test::run_program(MBS_CONTROLS, "check --ladder --time-limit " +
                                                       std::string(hangs ? "2" : "60") +
                                                       " --implementation " + fall.variant +
                                                       " --json '" + file + "'");
  EXPECT_EQ(run.status, 1) << run.output;
  const json rows = json::parse(test::file_text(file)).at("rows");
  std::filesystem::remove(file);
  const json& last = rows.back();
  EXPECT_EQ(last.at("rung"), fall.rung);
  EXPECT_EQ(last.at("result"), "FAILED");
  const auto failed = [](const json& row) { return row.at("result") == "FAILED"; };
  EXPECT_EQ(std::ranges::count_if(rows, failed), 1);
  EXPECT_TRUE(contains(last.at("row"), fall.row)) << last;
  EXPECT_TRUE(contains(last.at("detail"), fall.detail) || contains(last.at("differs"), fall.detail))
      << last;
  const auto named = [&](const json& mistake) { return contains(mistake, fall.mistake); };
  EXPECT_TRUE(std::ranges::any_of(last.at("mistakes"), named)) << last;
  for (const char* key : {"quantity", "row", "detail", "equation", "command"}) {
    EXPECT_TRUE(contains(run.output, last.at(key))) << key << run.output;
  }
  EXPECT_TRUE(contains(run.output, "more: build/mbs ")) << run.output;
  EXPECT_TRUE(contains(run.output, fall.mistake)) << run.output;
}

INSTANTIATE_TEST_SUITE_P(
    Ladder, PlantedMistake,
    ::testing::Values(
        Fall{"planted/half_jacobian", "Phi_q", "row ", "0.5 times the reference's",
             "the factor 2 of a distance"},
        Fall{"planted/half_mass", "f", "B", "differ", "half of M"},
        Fall{"planted/lambda_sign", "lambda", "row ", "differ", "the sign: lambda + alpha Phi"},
        Fall{"planted/lambda_first", "f", "B", "differ", "lambda is updated before the residual"},
        Fall{"planted/hidden_lambda_first", "Delta q", "B", "differ",
             "lambda is updated before the residual"},
        Fall{"planted/no_curvature", "a'", "B", "differ", "leaves out (dPhi_q/dt) v'"},
        Fall{"planted/always_both", "--projections velocity", "", "a differs",
             "does not look at the setting"},
        Fall{"skeleton/first", "predict", "B", "differ", "nothing is predicted yet"},
        Fall{"control/crashes", "Delta q", "", "killed by signal", "an index is out of range"},
        Fall{"control/hangs", "Delta q", "", "did not finish", "a loop has no end"}),
    [](const auto& info) { return test::gtest_name(info.param.variant); });

TEST(Ladder, ASoundImplementationGoesUpAsFarAsItServes) {
  const std::string file = test::temporary_path("ladder.json");
  const auto run = test::run_program(MBS_CONTROLS, "check --ladder --implementation planted/right --json '" + file + "'");
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
  for (const char* line : {"  ok         Phi_q", "  ok         fill", "  ok         chain, planar",
                           "  ok         --projections none", " more (--json FILE names all)"}) {
    EXPECT_TRUE(contains(run.output, line)) << line << '\n' << run.output;
  }
  const json rows = json::parse(test::file_text(file)).at("rows");
  std::vector<std::string> not_served;
  for (const json& row : rows) {
    if (row.at("result") == "not served") not_served.push_back(row.at("rung"));
  }
  std::filesystem::remove(file);
  for (const char* rung : {"chain, spatial", "--scheme rattle"}) {
    EXPECT_TRUE(std::ranges::count(not_served, rung)) << rung;
  }
  EXPECT_TRUE(contains(run.output, "\nall that it serves is right: ")) << run.output;
}

TEST(Ladder, NothingServedIsNothingRight) {
  const auto run =
      test::run_program(MBS_CONTROLS, "check --ladder --implementation control/unsupported");
  EXPECT_EQ(run.status, 1);
  EXPECT_FALSE(contains(run.output, "is right")) << run.output;
  EXPECT_EQ(run.errors,
            "mbs: control/unsupported: nothing was checked: it serves no rung (only even "
            "numbers\\x0Aof loops)\n");
}

TEST(Ladder, WhatIsNotShownIsNotYet) {
  const auto run =
      test::run_program(MBS_CONTROLS, "check --ladder --implementation control/returns_at_once");
  EXPECT_TRUE(contains(run.output, "  not yet    T")) << run.output;
  EXPECT_TRUE(contains(run.output, "  FAILED     Delta q")) << run.output;
}

TEST(Ladder, HasScenesAndSettingsOfItsOwn) {
  for (const char* also : {"four-bar:1", "--step 1e-3", "--scheme rattle"}) {
    const auto run = test::run_program(MBS_CONTROLS, std::string("check --ladder ") + also);
    EXPECT_EQ(run.status, 2) << also;
    EXPECT_TRUE(contains(run.errors, "--ladder")) << run.errors;
  }
}

/// The rungs that take no long run, of every implementation.
class StepRungs : public ::testing::TestWithParam<NamedVariant> {};

TEST_P(StepRungs, AreRightOnEveryTermServed) {
  const Variant& variant = *GetParam().variant;
  int looked_at = 0;
  for (const TermModel& term : term_models()) {
    if (!why_not_served(variant.serves.terms, term.model).empty()) continue;
    SCOPED_TRACE(term.name);
    const Model& model = term.model;
    const StepSettings settings = term_settings(model);
    const State state = moved_state(model, initial_state(model), settings.penalty);
    const auto make = [&](const StepSettings& one) {
      return create_simulation(variant, model, one);
    };
    for (const StepRung& rung : step_rungs()) {
      const Compared compared = compare_step(rung, make, model, settings, state);
      ++looked_at;
      ASSERT_FALSE(compared.finding)
          << rung.name << ": " << compared.finding->quantity << " " << compared.finding->row << ": "
          << compared.finding->value.value_or(NAN) << " instead of "
          << compared.finding->reference.value_or(NAN) << "; " << compared.finding->detail;
    }
  }
  EXPECT_GE(looked_at, static_cast<int>(step_rungs().size()));
}

INSTANTIATE_TEST_SUITE_P(All, StepRungs, ::testing::ValuesIn(all_variants()),
                         [](const auto& info) { return test::gtest_name(info.param.name); });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(StepRungs);

TEST(Ladder, TheExampleGoesAllTheWayUp) {
  const auto run = test::run_mbs("check --ladder --implementation minimal_dense");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_FALSE(contains(run.output, "  not yet ")) << run.output;
}

using Values = std::vector<double>;

json reference(const std::string& arguments) {
  const auto run = test::run_program(MBS_REFERENCE, "reference " + arguments);
  EXPECT_EQ(run.status, 0) << run.errors;
  return json::parse(run.output);
}

double largest_of(const Values& x) {
  double largest = 0.0;
  for (const double value : x) largest = std::max(largest, std::abs(value));
  return largest;
}

/// What `mbs reference` prints of a model with all terms, against the harness's own mathematics.
class ReferenceNumbers : public ::testing::TestWithParam<const char*> {};

TEST_P(ReferenceNumbers, AreThoseOfTheEquations) {
  const auto models = term_models();
  const Model& model = std::ranges::find(models, GetParam(), &TermModel::name)->model;
  const json printed =
      reference("'" + std::string(GetParam()) + "' --step 2.5e-4 --moved --after 2");
  const auto n = static_cast<std::size_t>(model.variables());
  const auto m = static_cast<std::size_t>(model.constraints());
  const double h = printed.at("step"), alpha = printed.at("penalty");
  const Values q = printed.at("predicted").at("q"), v = printed.at("predicted").at("v"),
               a = printed.at("predicted").at("a");
  const double t = printed.at("state").at("t").get<double>() + h;
  EXPECT_NEAR(t, 3 * h, 1e-15);
  EXPECT_EQ(printed.at("variables").size(), n);
  EXPECT_EQ(printed.at("constraints").size(), m);

  Values phi(m);
  evaluate_constraints(model, t, q, phi);
  EXPECT_GT(largest_of(phi), 1e-9);  // far above rounding
  std::vector<Values> Phi_q = printed.at("Phi_q");
  for (std::size_t k = 0; k < m; ++k)
    EXPECT_NEAR(printed.at("Phi")[k].get<double>(), phi[k], 1e-13);
  for (std::size_t i = 0; i < n; ++i) {  // Phi is quadratic: central differences are exact
    constexpr double kWay = 1e-3;
    Values there = q, back = q, phi_there(m), phi_back(m);
    there[i] += kWay, back[i] -= kWay;
    evaluate_constraints(model, t, there, phi_there);
    evaluate_constraints(model, t, back, phi_back);
    for (std::size_t k = 0; k < m; ++k) {
      EXPECT_NEAR(Phi_q[k][i], (phi_there[k] - phi_back[k]) / (2 * kWay), 1e-11);
    }
  }

  Values f(n), force(n);
  mass_times(model, a, f);
  applied_force(model, t, q, v, force);
  const Values lambda = printed.at("state").at("lambda");
  for (std::size_t i = 0; i < n; ++i) {
    f[i] -= force[i];
    for (std::size_t k = 0; k < m; ++k) f[i] += Phi_q[k][i] * (lambda[k] + alpha * phi[k]);
    f[i] *= h * h / 4;
  }
  const double size = largest_of(f);
  const std::vector<Values> T = printed.at("T");
  const json& after = printed.at("after_one_pass");
  const Values delta = after.at("Delta_q");
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_NEAR(printed.at("f")[i].get<double>(), f[i], 1e-11 * size);  // Eq. (3)
    double product = f[i];
    for (std::size_t j = 0; j < n; ++j) product += T[i][j] * delta[j];
    EXPECT_NEAR(product, 0.0, 1e-9 * size);  // Eq. (4)
    EXPECT_NEAR(after.at("v")[i].get<double>(), v[i] + 2 / h * delta[i], 1e-9 * 2 / h);
  }
  evaluate_constraints(model, t, after.at("q").get<Values>(), phi);
  for (std::size_t k = 0; k < m; ++k) {  // Eq. (1)
    EXPECT_NEAR(after.at("lambda")[k].get<double>(), lambda[k] + alpha * phi[k], 1e-12 * alpha);
  }
}

INSTANTIATE_TEST_SUITE_P(Ladder, ReferenceNumbers,
                         ::testing::Values("everything, planar", "everything, spatial"),
                         [](const auto& info) { return test::gtest_name(info.param); });

TEST(ReferenceCommand, IsAtTheStartUnlessAsked) {
  const json printed = reference("four-bar:1");
  EXPECT_EQ(printed.at("state").at("t"), 0.0);
  EXPECT_EQ(printed.at("state").at("q"), json({0.0, 1.0, 1.0, 1.0}));
  EXPECT_EQ(printed.at("variables"), json({"B0.x", "B0.y", "B1.x", "B1.y"}));
  EXPECT_EQ(printed.at("after_the_step").at("converged"), true);
}

TEST(ReferenceCommand, RefusesBadInput) {
  for (const auto& [arguments, word] :
       {std::pair("four-bar:1 --after -1", "--after"), std::pair("four-bar:2000", "2000 at most"),
        std::pair("four-bar:1 --step 0", "--step"),
        std::pair("four-bar:1 --penalty -1", "--penalty"),
        std::pair("'springs, flat'", "springs, flat")}) {
    const auto run = test::run_program(MBS_REFERENCE, std::string("reference ") + arguments);
    EXPECT_EQ(run.status, 2) << arguments;
    EXPECT_EQ(run.output, "") << arguments;
    EXPECT_TRUE(contains(run.errors, word)) << run.errors;
  }
}

}  // namespace
}  // namespace mbs
