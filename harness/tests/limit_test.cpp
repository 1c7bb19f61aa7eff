// The hand-written limit code: the same step as the reference's, for one mechanism only; its
// counts.
#include "limit/limit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "check/gate.hpp"
#include "limit/chain_state.hpp"
#include "limit/count.hpp"
#include "reference/reference_simulation.hpp"
#include "registry/factory.hpp"
#include "registry/registry.hpp"
#include "run/settings.hpp"
#include "run/stretch.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"
#include "support/allocation_counter.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = a.size() == b.size() ? 0.0 : HUGE_VAL;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (!(std::abs(a[i] - b[i]) <= worst)) worst = std::abs(a[i] - b[i]);
  }
  return worst;
}

/// Every way in which the blocks may meet in the middle, and a singular position on the way.
TEST(LimitCode, FollowsTheReference) {
  for (const int loops : {1, 2, 3, 4, 5, 6, 11, 24}) {
    SCOPED_TRACE(loops);
    const Scene scene = load_scene("four-bar:" + std::to_string(loops));
    const StepSettings settings = chosen(scene.model);
    const Stretch stretch = make_stretch(scene, settings.step, 120);
    const auto simulation = limit::variant().create(scene.model, settings);
    ReferenceSimulation reference(scene.model, settings);
    simulation->set_state(stretch.initial);
    reference.set_state(stretch.initial);
    long differing = 0;
    for (int i = 0; i < stretch.steps; ++i) {
      differing += simulation->step().passes != reference.step().passes;
    }
    State found, expected;
    simulation->get_state(found);
    reference.get_state(expected);
    EXPECT_LE(differing, 1);  // at the singular position rounding may decide
    EXPECT_LT(distance(found.q, expected.q), 1e-10);
    EXPECT_LT(distance(found.v, expected.v), 1e-8);
    EXPECT_LT(distance(found.a, expected.a), 1e-4);
    EXPECT_LT(distance(found.lambda, expected.lambda), 1e-3);
  }
}

TEST(LimitCode, PassesTheGate) {
  for (const char* name : {"four-bar:9", "four-bar:10"}) {
    const Scene scene = load_scene(name);
    const StepSettings settings = chosen(scene.model);
    const NamedVariant variant = select_variants({"limit"}).front();
    const Verdict verdict =
        check_implementation(scene, variant, settings, run_reference(scene, settings));
    EXPECT_EQ(verdict.verdict, "agrees") << verdict.reason;
    EXPECT_EQ(verdict.implementation, "limit/limit");
  }
}

TEST(LimitCode, TellsThePassLimit) {
  const Scene scene = load_scene("four-bar:4");
  StepSettings settings = chosen(scene.model);
  settings.max_passes = 1;
  const Stretch stretch = make_stretch(scene, settings.step, 2);
  const auto simulation = limit::variant().create(scene.model, settings);
  simulation->set_state(stretch.initial);
  EXPECT_EQ(simulation->step().status, StepStatus::pass_limit);
  State state = stretch.initial;
  state.v[9] = 1e300;  // squares overflow: no number may pass for converged
  simulation->set_state(state);
  EXPECT_EQ(simulation->step().status, StepStatus::pass_limit);
}

TEST(LimitCode, IsReachedByNameOnly) {
  for (const NamedVariant& variant : all_variants()) EXPECT_NE(variant.name, limit::kName);
  for (const NamedVariant& variant : select_variants({})) EXPECT_NE(variant.name, limit::kName);
  for (const char* name : {"limit", "limit/limit"}) {
    const std::vector<NamedVariant> selected = select_variants({name});
    ASSERT_EQ(selected.size(), 1U);
    EXPECT_EQ(selected.front().variant, &limit::variant());
  }
  EXPECT_THROW((void)select_variants({"limit/fast"}), UsageError);
}

TEST(LimitCode, AllocatesNothingInAStep) {
  if (!test::counts_allocations()) GTEST_SKIP() << "sanitizers bring their own malloc";
  const Scene scene = load_scene("four-bar:40");
  const auto simulation = limit::variant().create(scene.model, chosen(scene.model));
  simulation->set_state(make_stretch(scene, 1.25e-3, 10).initial);
  const long before = test::allocations();
  for (int i = 0; i < 10; ++i) (void)simulation->step();
  EXPECT_EQ(test::allocations(), before);
}

/// The N-four-bar of 3 loops with one thing changed.
constexpr StepSettings kSome{.penalty = 1e8, .tolerance = 1e-9};

template <class Change>
void expect_refused(const char* what, Change change) {
  ModelData data = four_bar(3);
  change(data);
  const Model model(std::move(data));
  EXPECT_THROW((void)create_simulation(limit::variant(), model, kSome), Unsupported) << what;
}

TEST(LimitCode, RefusesEveryOtherModel) {
  EXPECT_NO_THROW((void)create_simulation(limit::variant(), Model(four_bar(3)), kSome));
  expect_refused("length", [](ModelData& d) { d.dot_constraints[2].value = 1.21; });
  expect_refused("mass", [](ModelData& d) { d.mass[0].value *= 1.001; });
  expect_refused("stored zero", [](ModelData& d) { d.mass.push_back({7, 0, 0.0}); });
  expect_refused("gravity", [](ModelData& d) { d.force[1] = -9.8; });
  expect_refused("ground", [](ModelData& d) { d.points[1].position[0] = 1.5; });
  expect_refused("a rod less", [](ModelData& d) { d.dot_constraints.pop_back(); });
  expect_refused("another pair", [](ModelData& d) { d.dot_constraints[0].c = 5; });
  expect_refused("spring", [](ModelData& d) { d.springs = {{0, 5, 10.0, 0.0, 1.0, "s"}}; });
  expect_refused("couple", [](ModelData& d) { d.couples = {{4, 0, -1, 1.0, "c"}}; });
  expect_refused("linear", [](ModelData& d) { d.linear_constraints = {{{{0, 1.0}}, 0.0, "l"}}; });
  expect_refused("driven", [](ModelData& d) { d.driven_values = {{0, TimeFunction(1.0)}}; });
  for (const char* name : {"four-bar:3,fill=0.9"}) {
    const Scene scene = load_scene(name);
    EXPECT_THROW((void)create_simulation(limit::variant(), scene.model, kSome), Unsupported);
  }
}

TEST(LimitCode, RefusesOtherSettings) {
  const Model model(four_bar(3));
  for (StepSettings settings :
       {StepSettings{.projections = Projections::none},
        StepSettings{.projections = Projections::velocity},
        StepSettings{.scheme = Scheme::saddle_point}, StepSettings{.tangent = TangentReuse::kept},
        StepSettings{.precision = Precision::mixed}}) {
    settings.penalty = kSome.penalty;
    settings.tolerance = kSome.tolerance;
    EXPECT_THROW((void)create_simulation(limit::variant(), model, settings), Unsupported);
  }
}

}  // namespace
}  // namespace mbs
