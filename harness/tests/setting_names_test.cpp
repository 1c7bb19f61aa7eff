// Names of settings, the combinations that are refused, and who serves what.
#include "run/setting_names.hpp"

#include <gtest/gtest.h>

#include "support/term_models.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

std::string refusal(const StepSettings& settings) {
  try {
    require_combination(settings);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(SettingNames, EveryChoiceHasItsNameAndTheDefaultComesFirst) {
  const StepSettings usual;
  EXPECT_EQ(choices<Scheme>().front().second, usual.scheme);
  EXPECT_EQ(choices<Projections>().front().second, usual.projections);
  EXPECT_EQ(choices<MultiplierUpdate>().front().second, usual.multipliers);
  EXPECT_EQ(choices<TangentReuse>().front().second, usual.tangent);
  EXPECT_EQ(choices<Precision>().front().second, usual.precision);
  EXPECT_EQ(other_settings(usual), "");
  StepSettings other;
  other.scheme = Scheme::saddle_point;
  other.projections_every = 4;
  other.precision = Precision::mixed;
  EXPECT_EQ(other_settings(other), "--scheme saddle-point --projections-every 4 --precision mixed");
  EXPECT_EQ(settings_json(other).at("tangent"), "every-pass");
}

TEST(SettingNames, CombinationsThatDoNotGoTogetherAreRefusedByName) {
  EXPECT_EQ(refusal({}), "");
  EXPECT_EQ(refusal({.projections_every = 0}), "--projections-every is 0: it must be at least 1");
  EXPECT_EQ(refusal({.scheme = Scheme::saddle_point, .multipliers = MultiplierUpdate::converged}),
            "--scheme saddle-point and --multipliers converged do not go together: it goes with "
            "every-pass");
  for (const Scheme scheme :
       {Scheme::rattle, Scheme::rattle4, Scheme::rattle6, Scheme::multistep6}) {
    EXPECT_EQ(refusal({.scheme = scheme}), "");
    EXPECT_NE(refusal({.projections = Projections::velocity, .scheme = scheme}), "");
    EXPECT_NE(refusal({.projections_every = 2, .scheme = scheme}), "");
    EXPECT_NE(refusal({.scheme = scheme, .multipliers = MultiplierUpdate::converged}), "");
    EXPECT_NE(refusal({.scheme = scheme, .tangent = TangentReuse::kept}), "");
    EXPECT_NE(refusal({.scheme = scheme, .precision = Precision::mixed}), "");
    EXPECT_NE(refusal({.scheme = scheme, .geometric_stiffness = true}), "");
    EXPECT_EQ(refusal({.scheme = scheme, .precision = Precision::single_precision}).empty(),
              scheme != Scheme::multistep6);
  }
  EXPECT_NE(refusal({.projections = Projections::none, .projections_every = 2}), "");
}

TEST(SettingNames, WhatAVariantDoesNotServeIsSaid) {
  const Serves nothing, everything{true, true, true, true, true, true, true, true, true};
  for (const auto& [settings, option] : std::vector<std::pair<StepSettings, std::string>>{
           {{.scheme = Scheme::saddle_point}, "--scheme saddle-point"},
           {{.scheme = Scheme::rattle4}, "--scheme rattle4"},
           {{.multipliers = MultiplierUpdate::converged}, "--multipliers converged"},
           {{.tangent = TangentReuse::step}, "--tangent every-step"},
           {{.projections_every = 2}, "--projections-every"},
           {{.precision = Precision::single_precision}, "--precision single"},
           {{.geometric_stiffness = true}, "--geometric-stiffness"},
           {{.precision = Precision::mixed}, "--precision mixed"}}) {
    EXPECT_EQ(why_not_served(nothing, settings), option);
    EXPECT_EQ(why_not_served(everything, settings), "") << option;
  }
  EXPECT_EQ(why_not_served(nothing, {}), "");
}

TEST(SettingNames, RattleIsForScenesWithoutDriversAndDampers) {
  int suited = 0, unsuited = 0;
  for (const test::TermModel& term : test::term_models()) {
    EXPECT_EQ(why_unsuited(term.model, {}), "");
    (why_unsuited(term.model, {.scheme = Scheme::rattle}).empty() ? suited : unsuited) += 1;
  }
  EXPECT_GT(suited, 0);
  EXPECT_GT(unsuited, 0);
}

}  // namespace
}  // namespace mbs
