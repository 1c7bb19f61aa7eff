// A state that is set is where a simulation goes on from, whatever it did before.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "registry/factory.hpp"
#include "registry/registry.hpp"
#include "registry/setting_names.hpp"
#include "run/settings.hpp"
#include "run/stretch.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"
#include "support/gtest_name.hpp"

namespace mbs {
namespace {

class SetState : public ::testing::TestWithParam<NamedVariant> {};

/// n = 12: no multiple of a register's doubles.
TEST_P(SetState, IsTheWayBackFromAStepThatWasNotFinite) {
  const Scene scene = load_scene("four-bar:5");
  for (const Scheme scheme :
       {Scheme::penalty, Scheme::saddle_point, Scheme::rattle, Scheme::multistep6}) {
    const StepSettings settings = chosen(scene.model, {.scheme = scheme});
    const State start = make_stretch(scene, settings.step, 10).initial;
    std::unique_ptr<Simulation> simulation;
    try {
      simulation = create_simulation(*GetParam().variant, scene.model, settings);
    } catch (const Unsupported&) {
      continue;  // `mbs check` is where this is reported
    }
    State first = start, again = start, broken = start;
    simulation->set_state(start);
    (void)simulation->step();
    simulation->get_state(first);
    // Finite, but forces from it are not: the first factors are sound, what is solved for is not,
    // and so no later matrix.
    std::ranges::fill(is_explicit(scheme) ? broken.v : broken.lambda, 1.7e308);
    simulation->set_state(broken);
    EXPECT_EQ(simulation->step().status, StepStatus::factorization_failed);
    // As they are after it: the next step says so at once.
    const StepOutcome outcome = simulation->step();
    EXPECT_EQ(outcome.status, StepStatus::factorization_failed);
    EXPECT_GE(outcome.passes, 1);
    simulation->set_state(start);
    EXPECT_NE(simulation->step().status, StepStatus::factorization_failed);
    simulation->get_state(again);
    for (std::size_t i = 0; i < first.q.size(); ++i) {
      EXPECT_NEAR(again.q[i], first.q[i], 1e-12);
      EXPECT_NEAR(again.v[i], first.v[i], 1e-9);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, SetState, ::testing::ValuesIn(all_variants()),
                         [](const auto& info) { return test::gtest_name(info.param.name); });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SetState);

}  // namespace
}  // namespace mbs
