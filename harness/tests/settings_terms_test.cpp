// Every implementation with every setting that it serves beyond the defaults, on every term of the
// equations, against the reference.
#include <gtest/gtest.h>

#include "check/gate.hpp"
#include "registry/factory.hpp"
#include "registry/registry.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "support/gtest_name.hpp"
#include "support/term_models.hpp"

namespace mbs {
namespace {

using TermCase = std::tuple<NamedVariant, SettingCase>;
class SettingsTerms : public ::testing::TestWithParam<TermCase> {};

TEST_P(SettingsTerms, Agree) {
  const auto& [variant, setting] = GetParam();
  for (const TermModel& term : term_models()) {
    // For the trapezoidal rule, and for RATTLE.
    const bool telling = term.name == "everything, spatial" || term.name == "couples, planar";
    if (test::kSlowReference && !telling) continue;
    SCOPED_TRACE(term.name);
    const Scene scene{term.name, term.model, {}, {}};
    const StepSettings settings = term_settings(scene.model, setting.settings);
    const bool suited = why_unsuited(scene.model, settings).empty();
    static const ReferenceRun none;
    const ReferenceRun& reference =
        suited ? test::kept_reference(setting.name, scene, settings) : none;
    const Verdict verdict = check_in_process(scene, variant, settings, reference);
    const bool served = why_not_served(variant.variant->serves, scene.model, settings).empty();
    EXPECT_EQ(verdict.verdict, suited && served ? "agrees" : "unsupported") << verdict.reason;
  }
}

/// Two rods and the one between their ends, hanging at rest.
Model hanging() {
  ModelData data;
  data.points = {
      {"A", -1, {0.0, 0.0}}, {"B", -1, {1.0, 0.0}}, {"C", 0, {0.0, -1.0}}, {"D", 2, {1.0, -1.0}}};
  data.dot_constraints = {
      {2, 0, 2, 0, 1.0, "AC"}, {3, 1, 3, 1, 1.0, "BD"}, {3, 2, 3, 2, 1.0, "CD"}};
  for (int i = 0; i < 4; ++i) data.mass.push_back({i, i, 1.0});
  data.force = {0.0, -9.81, 0.0, -9.81};
  data.initial_velocity.assign(4, 0.0);
  return Model(std::move(data));
}

/// Residuals become smaller than any number that has an inverse.
TEST(MixedPrecision, StaysAtRest) {
  const Model model = hanging();
  for (const NamedVariant& variant : all_variants()) {
    if (!variant.variant->serves.mixed_precision) continue;
    SCOPED_TRACE(variant.name);
    for (const Scheme scheme : {Scheme::penalty, Scheme::saddle_point}) {
      const StepSettings settings =
          chosen(model, {.scheme = scheme, .precision = Precision::mixed});
      const auto simulation = create_simulation(*variant.variant, model, settings);
      State state = initial_state(model);
      simulation->set_state(state);
      for (int i = 0; i < 400; ++i) EXPECT_EQ(simulation->step().status, StepStatus::converged);
      simulation->get_state(state);
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(state.q[i], model.initial_position()[i], 1e-9);
      }
    }
  }
}

/// The settings that take most paths at once, for builds in which every one takes seconds.
bool tells_much(const SettingCase& setting) {
  for (const char* name : {"saddle_point", "saddle_point_kept", "rattle4", "multistep6",
                           "converged", "single_saddle_point", "mixed_kept", "geometric_kept"}) {
    if (setting.name == name) return true;
  }
  return false;
}

/// Setting by setting, for kept_reference().
std::vector<TermCase> cases() {
  std::vector<TermCase> result;
  for (const SettingCase& setting : setting_cases()) {
    if (test::kSlowReference && !tells_much(setting)) continue;
    const RegistryEntry* last = nullptr;
    for (const NamedVariant& variant : all_variants()) {
      if (test::kSlowReference && variant.entry == last) continue;
      last = variant.entry;
      if (why_not_served(variant.variant->serves, setting.settings).empty()) {
        result.emplace_back(variant, setting);
      }
    }
  }
  return result;
}

std::string setting_test_name(const ::testing::TestParamInfo<TermCase>& info) {
  const auto& [variant, setting] = info.param;
  return test::gtest_name(variant.name + "_" + setting.name);
}

INSTANTIATE_TEST_SUITE_P(All, SettingsTerms, ::testing::ValuesIn(cases()), setting_test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SettingsTerms);

}  // namespace
}  // namespace mbs
