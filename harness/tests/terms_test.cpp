// Every implementation on every term of the equations, against the reference.
#include <gtest/gtest.h>

#include "check/gate.hpp"
#include "registry/factory.hpp"
#include "registry/registry.hpp"
#include "support/gtest_name.hpp"
#include "support/term_models.hpp"

namespace mbs {
namespace {

class EveryTerm : public ::testing::TestWithParam<NamedVariant> {};

void expect_agreement(const NamedVariant& variant, const char* name, Projections projections) {
  for (const TermModel& term : term_models()) {
    if (test::kSlowReference && !term.name.starts_with("everything")) continue;
    SCOPED_TRACE(term.name);
    const Scene scene{term.name, term.model, {}, {}};
    const StepSettings settings = term_settings(scene.model, {.projections = projections});
    const Verdict verdict =
        check_in_process(scene, variant, settings, test::kept_reference(name, scene, settings));
    const bool served = why_not_served(variant.variant->serves, scene.model, settings).empty();
    EXPECT_EQ(verdict.verdict, served ? "agrees" : "unsupported") << verdict.reason;
  }
}

TEST_P(EveryTerm, Agree) { expect_agreement(GetParam(), "both", Projections::both); }
#if !defined(__SANITIZE_ADDRESS__)  // whoever leaves projections out runs nothing else
TEST_P(EveryTerm, AgreeWithoutProjections) {
  expect_agreement(GetParam(), "none", Projections::none);
}
TEST_P(EveryTerm, AgreeWithProjectedVelocities) {
  expect_agreement(GetParam(), "velocity", Projections::velocity);
}
#endif

std::string term_test_name(const ::testing::TestParamInfo<NamedVariant>& info) {
  return test::gtest_name(info.param.name);
}

INSTANTIATE_TEST_SUITE_P(All, EveryTerm, ::testing::ValuesIn(all_variants()), term_test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryTerm);

}  // namespace
}  // namespace mbs
