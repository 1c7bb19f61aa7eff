// Every implementation on every term of the equations, against the reference.
#include <gtest/gtest.h>

#include "check/gate.hpp"
#include "registry/registry.hpp"
#include "run/settings.hpp"
#include "support/gtest_name.hpp"
#include "support/left_to_another.hpp"
#include "support/term_models.hpp"

namespace mbs {
namespace {

StepSettings settings_for(const Model& model, Projections projections) {
  StepSettings settings;
  settings.step = 2.5e-4;  // 800 steps: short enough that no driver forces what geometry forbids
  settings.penalty = automatic_penalty(model, settings);
  settings.tolerance = automatic_tolerance(model, settings);
  settings.projections = projections;
  return settings;
}

class Terms : public ::testing::TestWithParam<NamedVariant> {};

void expect_agreement(const NamedVariant& variant, const char* name, Projections projections) {
  for (const test::TermModel& term : test::term_models()) {
    if (test::kSlowReference && !term.name.starts_with("everything")) continue;
    SCOPED_TRACE(term.name);
    const Scene scene{term.name, term.model, {}, {}};
    const StepSettings settings = settings_for(scene.model, projections);
    const Verdict verdict =
        check_implementation(scene, variant, settings, test::kept_reference(name, scene, settings));
    if (test::is_left_to_another(verdict, variant, scene.model, settings)) continue;
    EXPECT_EQ(verdict.verdict, "agrees") << verdict.reason;
  }
}

TEST_P(Terms, Agree) { expect_agreement(GetParam(), "both", Projections::both); }
TEST_P(Terms, AgreeWithoutProjections) { expect_agreement(GetParam(), "none", Projections::none); }
TEST_P(Terms, AgreeWithProjectedVelocities) {
  expect_agreement(GetParam(), "velocity", Projections::velocity);
}

std::string test_name(const ::testing::TestParamInfo<NamedVariant>& info) {
  return test::gtest_name(info.param.name);
}

INSTANTIATE_TEST_SUITE_P(All, Terms, ::testing::ValuesIn(all_variants()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Terms);

}  // namespace
}  // namespace mbs
