// Names of settings, the combinations that are refused, and who serves what.
#include "registry/setting_names.hpp"

#include <gtest/gtest.h>

#include "usage_error.hpp"

namespace mbs {
namespace {

std::string refusal_of(const StepSettings& settings) {
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
  EXPECT_EQ(refusal_of({}), "");
  EXPECT_EQ(refusal_of({.projections_every = 0}), "--projections-every is 0: it must be at least 1");
  EXPECT_EQ(refusal_of({.scheme = Scheme::saddle_point, .multipliers = MultiplierUpdate::converged}),
            "--scheme saddle-point and --multipliers converged do not go together: it goes with "
            "every-pass");
  for (const Scheme scheme :
       {Scheme::rattle, Scheme::rattle4, Scheme::rattle6, Scheme::multistep6}) {
    EXPECT_EQ(refusal_of({.scheme = scheme}), "");
    EXPECT_NE(refusal_of({.projections = Projections::velocity, .scheme = scheme}), "");
    EXPECT_NE(refusal_of({.projections_every = 2, .scheme = scheme}), "");
    EXPECT_NE(refusal_of({.scheme = scheme, .multipliers = MultiplierUpdate::converged}), "");
    EXPECT_NE(refusal_of({.scheme = scheme, .tangent = TangentReuse::kept}), "");
    EXPECT_NE(refusal_of({.scheme = scheme, .precision = Precision::mixed}), "");
    EXPECT_NE(refusal_of({.scheme = scheme, .geometric_stiffness = true}), "");
    EXPECT_EQ(refusal_of({.scheme = scheme, .precision = Precision::single_precision}).empty(),
              scheme != Scheme::multistep6);
  }
  EXPECT_NE(refusal_of({.projections = Projections::none, .projections_every = 2}), "");
}

}  // namespace
}  // namespace mbs
