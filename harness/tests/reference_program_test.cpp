// `mbs_reference`, the program with the reference as its only implementation, as a user meets it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "support/program.hpp"

namespace mbs {
namespace {

nlohmann::json simulate(const std::string& arguments) {
  const auto run = test::run_program(
      MBS_REFERENCE, "simulate --json --implementation reference/reference " + arguments);
  EXPECT_EQ(run.status, 0) << run.errors;
  return nlohmann::json::parse(run.output);
}

TEST(ReferenceProgram, ListsItselfAndNobodyElse) {
  const auto run = test::run_program(MBS_REFERENCE, "list --json");
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto listed = nlohmann::json::parse(run.output).at("implementations");
  ASSERT_EQ(listed.size(), 1U);
  const auto variants = listed[0].at("variants");
  ASSERT_EQ(variants.size(), 1U);
  EXPECT_EQ(variants[0].at("name"), "reference/reference");
}

TEST(ReferenceProgram, FollowsTheExactMotionToSecondOrder) {
  const auto error = [](const char* step) {
    const auto summary =
        simulate(std::string("four-bar:2 --duration 0.3 --judge-every 1 --step ") + step);
    EXPECT_EQ(summary.at("status"), "ok");
    return summary.at("position_error_max").get<double>();
  };
  const double fine = error("1.25e-3");
  EXPECT_LT(fine, 0.65 * 1.25e-3 * 1.25e-3);  // harness/src/check/README.md
  EXPECT_NEAR(error("2.5e-3") / fine, 4.0, 0.3);
}

TEST(ReferenceProgram, ServesEverySetting) {
  for (const char* setting : {"--scheme saddle-point", "--scheme rattle", "--scheme multistep6",
                              "--multipliers converged", "--tangent kept", "--precision mixed",
                              "--projections-every 2", "--geometric-stiffness"}) {
    const auto summary = simulate(std::string("four-bar:2 --duration 0.1 ") + setting);
    EXPECT_EQ(summary.at("status"), "ok") << setting;
  }
}

TEST(ReferenceProgram, RefusesToGoBeyondADriversEnd) {
  const auto run = test::run_mbs("reference '" MBS_ROOT
                                 "/harness/scenes/examples/quarter_car.json' --step 0.01 --after 2000");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.errors.find("a driver's table ends at 5 s"), std::string::npos) << run.errors;
}

TEST(ReferenceProgram, KnowsNoOtherImplementation) {
  const auto run =
      test::run_program(MBS_REFERENCE, "simulate four-bar:1 --implementation csc_klu/refactor");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.errors.find("reference/reference"), std::string::npos) << run.errors;
}

}  // namespace
}  // namespace mbs
