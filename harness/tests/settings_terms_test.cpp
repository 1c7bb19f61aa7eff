// Every implementation with every setting that it serves beyond the defaults, on every term of the
// equations, against the reference.
#include <gtest/gtest.h>

#include <algorithm>

#include "check/gate.hpp"
#include "registry/registry.hpp"
#include "run/setting_names.hpp"
#include "run/settings.hpp"
#include "support/term_models.hpp"

namespace mbs {
namespace {

/// Sanitizers make the reference slow: with them one variant a folder and two models must do.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kFewer = true;
#else
constexpr bool kFewer = false;
#endif

struct Setting {
  std::string name;
  StepSettings settings;
};

std::vector<Setting> all_settings() {
  std::vector<Setting> result;
  const auto add = [&result](const char* name, auto change) {
    StepSettings settings;
    settings.step = 2.5e-4;  // short enough that no driver forces what geometry forbids
    change(settings);
    result.push_back({name, settings});
  };
  using S = StepSettings;
  add("saddle_point", [](S& s) { s.scheme = Scheme::saddle_point; });
  add("saddle_point_every_step", [](S& s) {
    s.scheme = Scheme::saddle_point;
    s.tangent = TangentReuse::step;
  });
  add("saddle_point_kept", [](S& s) {
    s.scheme = Scheme::saddle_point;
    s.tangent = TangentReuse::kept;
  });
  add("saddle_point_unprojected", [](S& s) {
    s.scheme = Scheme::saddle_point;
    s.projections = Projections::none;
  });
  add("saddle_point_velocities", [](S& s) {
    s.scheme = Scheme::saddle_point;
    s.projections = Projections::velocity;
    s.projections_every = 2;
  });
  add("rattle", [](S& s) { s.scheme = Scheme::rattle; });
  add("rattle4", [](S& s) { s.scheme = Scheme::rattle4; });
  add("rattle6", [](S& s) { s.scheme = Scheme::rattle6; });
  add("converged", [](S& s) { s.multipliers = MultiplierUpdate::converged; });
  add("every_step", [](S& s) { s.tangent = TangentReuse::step; });
  add("kept", [](S& s) { s.tangent = TangentReuse::kept; });
  add("every_third", [](S& s) { s.projections_every = 3; });
  add("single", [](S& s) { s.precision = Precision::single_precision; });
  add("single_saddle_point", [](S& s) {
    s.precision = Precision::single_precision;
    s.scheme = Scheme::saddle_point;
  });
  add("single_rattle", [](S& s) {
    s.precision = Precision::single_precision;
    s.scheme = Scheme::rattle;
  });
  add("mixed", [](S& s) { s.precision = Precision::mixed; });
  add("mixed_saddle_point", [](S& s) {
    s.precision = Precision::mixed;
    s.scheme = Scheme::saddle_point;
  });
  add("mixed_kept", [](S& s) {
    s.precision = Precision::mixed;
    s.tangent = TangentReuse::kept;
  });
  return result;
}

using Case = std::tuple<NamedVariant, Setting>;
class SettingsTerms : public ::testing::TestWithParam<Case> {};

TEST_P(SettingsTerms, Agree) {
  const auto& [variant, setting] = GetParam();
  for (const test::TermModel& term : test::term_models()) {
    // For the trapezoidal rule, and for RATTLE.
    const bool telling = term.name == "everything, spatial" || term.name == "couples, planar";
    if (kFewer && !telling) continue;
    SCOPED_TRACE(term.name);
    const Scene scene{term.name, term.model, {}, {}};
    StepSettings settings = setting.settings;
    settings.penalty =
        automatic_penalty(scene.model, settings.step, settings.scheme, settings.precision);
    settings.tolerance = automatic_tolerance(scene.model, settings);
    const bool suited = why_unsuited(scene.model, settings).empty();
    ReferenceRun reference;
    if (suited) reference = run_reference(scene, settings);
    const Verdict verdict = check_implementation(scene, variant, settings, reference);
    EXPECT_EQ(verdict.verdict, suited ? "agrees" : "unsupported") << verdict.reason;
  }
}

std::vector<Case> cases() {
  std::vector<Case> result;
  const RegistryEntry* last = nullptr;
  for (const NamedVariant& variant : all_variants()) {
    if (kFewer && variant.entry == last) continue;
    last = variant.entry;
    for (const Setting& setting : all_settings()) {
      if (why_not_served(variant.variant->serves, setting.settings).empty()) {
        result.emplace_back(variant, setting);
      }
    }
  }
  return result;
}

std::string test_name(const ::testing::TestParamInfo<Case>& info) {
  const auto& [variant, setting] = info.param;
  std::string name = variant.name + "_" + setting.name;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, SettingsTerms, ::testing::ValuesIn(cases()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SettingsTerms);

}  // namespace
}  // namespace mbs
