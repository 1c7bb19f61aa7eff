// The reference's schemes and other settings: orders, and that all of them solve the same problem.
#include <gtest/gtest.h>

#include <cmath>

#include "exact/four_bar_exact.hpp"
#include "reference/reference_simulation.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"
#include "support/sample_models.hpp"

namespace mbs {
namespace {

StepSettings with_scheme(const Model& model, Scheme scheme, double step) {
  StepSettings settings;
  settings.scheme = scheme;
  settings.step = step;
  settings.penalty = automatic_penalty(model, settings);
  settings.tolerance = 1e-15;
  settings.max_passes = 50;
  return settings;
}

struct SchemeMotion {
  State state;
  long passes = 0, factorizations = 0;
};

SchemeMotion run_reference_for(const Scene& scene, const StepSettings& settings, double duration) {
  ReferenceSimulation simulation(scene.model, settings);
  simulation.set_state(initial_state(scene.model));
  SchemeMotion run;
  for (long i = 0; i < std::lround(duration / settings.step); ++i) {
    const StepOutcome outcome = simulation.step();
    EXPECT_NE(outcome.status, StepStatus::factorization_failed);
    run.passes += outcome.passes;
    run.factorizations += outcome.factorizations;
  }
  simulation.get_state(run.state);
  return run;
}

double distance_between(const std::vector<double>& x, const std::vector<double>& y) {
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) worst = std::fmax(worst, std::abs(x[i] - y[i]));
  return worst;
}

TEST(ReferenceSchemes, AreOfTheirOrderBeforeTheSingularPosition) {
  constexpr double kDuration = 0.5;
  for (const int loops : {1, 3}) {
    const Scene scene = load_scene("four-bar:" + std::to_string(loops));
    const auto n = static_cast<std::size_t>(scene.model.variables());
    State exact;
    for (auto* values : {&exact.q, &exact.v, &exact.a}) values->resize(n);
    FourBarExact(loops).state(kDuration, exact.q, exact.v, exact.a);
    const auto order = [&](Scheme scheme, double step) {
      const auto error = [&](double h) {
        const StepSettings settings = with_scheme(scene.model, scheme, h);
        return distance_between(run_reference_for(scene, settings, kDuration).state.q, exact.q);
      };
      return std::log2(error(step) / error(step / 2));
    };
    EXPECT_NEAR(order(Scheme::saddle_point, 2e-3), 2.0, 0.05) << loops;
    EXPECT_NEAR(order(Scheme::rattle, 2e-3), 2.0, 0.05) << loops;
    EXPECT_NEAR(order(Scheme::rattle4, 1e-2), 4.0, 0.2) << loops;
    EXPECT_NEAR(order(Scheme::rattle6, 2.5e-2), 6.0, 0.4) << loops;
    EXPECT_NEAR(order(Scheme::multistep6, 1e-2), 6.0, 0.4) << loops;
  }
}

// By symmetry RATTLE on the N-four-bar is that of a pendulum on a circle: a step turns by the
// angle whose sine is h w + h^2 w'/2.
TEST(ReferenceSchemes, RattleTurnsTheFourBarAsItTurnsAPendulum) {
  const Scene scene = load_scene("four-bar:4");
  const StepSettings settings = with_scheme(scene.model, Scheme::rattle, 1e-2);
  ReferenceSimulation simulation(scene.model, settings);
  State state = initial_state(scene.model);
  simulation.set_state(state);
  const double k = 3 * 9.81 * 13 / (2 * 17.0);  // of Eq. (9)
  double angle = 0.0, rate = 1.0;
  for (int i = 0; i < 40; ++i) {
    ASSERT_EQ(simulation.step().status, StepStatus::converged);
    simulation.get_state(state);
    angle += std::asin(1e-2 * rate + 1e-4 / 2 * k * std::sin(angle));
    EXPECT_NEAR(state.q[0], std::sin(angle), 1e-12) << i;
    EXPECT_NEAR(state.q[1], std::cos(angle), 1e-12) << i;
    rate = std::hypot(state.v[0], state.v[1]);
    // a and lambda satisfy the equations of motion: |a|^2 = (w^2)^2 + (w')^2
    EXPECT_NEAR(std::hypot(state.a[0], state.a[1]), std::hypot(rate * rate, k * std::sin(angle)),
                1e-6)
        << i;
  }
}

// Converged, the penalty form is on the constraints with M a + Phi_q^T lambda = Q, as the
// saddle-point form is: only rounding tells them apart, whatever else is chosen.
TEST(ReferenceSchemes, SettingsChangeTheWayAndNotTheMotion) {
  const Scene scene = test::spatial_pendulum();
  const auto with = [&](auto change) {
    StepSettings settings = with_scheme(scene.model, Scheme::penalty, 1e-3);
    settings.tolerance = 1e-13;
    settings.tangent = TangentReuse::kept;  // which needs the smallest penalty factor
    settings.penalty = automatic_penalty(scene.model, settings);
    settings.tangent = TangentReuse::none;
    change(settings);
    return run_reference_for(scene, settings, 0.3);
  };
  using S = StepSettings;
  const SchemeMotion plain = with([](S&) {});
  EXPECT_EQ(plain.factorizations, plain.passes);
  const auto expect_same = [&](const SchemeMotion& run, const char* name, double allowed = 1e-9) {
    EXPECT_LT(distance_between(run.state.q, plain.state.q), allowed) << name;
    EXPECT_LT(distance_between(run.state.v, plain.state.v), 10 * allowed) << name;
  };
  expect_same(with([](S& s) { s.multipliers = MultiplierUpdate::converged; }), "converged");
  const SchemeMotion step = with([](S& s) { s.tangent = TangentReuse::step; });
  expect_same(step, "every step");
  EXPECT_EQ(step.factorizations, 300);
  const SchemeMotion kept = with([](S& s) { s.tangent = TangentReuse::kept; });
  expect_same(kept, "kept");
  const SchemeMotion saddle = with([](S& s) { s.scheme = Scheme::saddle_point; });
  expect_same(saddle, "saddle-point");
  const SchemeMotion saddle_kept = with([](S& s) {
    s.scheme = Scheme::saddle_point;
    s.tangent = TangentReuse::kept;
  });
  expect_same(saddle_kept, "saddle-point, kept", 1e-7);  // five refinements at most
  EXPECT_LT(saddle_kept.factorizations, 150);
  for (const Scheme scheme : {Scheme::penalty, Scheme::saddle_point}) {
    const SchemeMotion exact = with([scheme](S& s) {
      s.scheme = scheme;
      s.geometric_stiffness = true;
    });
    expect_same(exact, "geometric stiffness");
    EXPECT_LE(exact.passes, scheme == Scheme::penalty ? plain.passes : saddle.passes);
  }
}

TEST(ReferenceSchemes, ProjectsEveryKthStepOnly) {
  const Scene scene = test::spatial_pendulum();
  StepSettings settings = with_scheme(scene.model, Scheme::penalty, 1e-3);
  settings.tolerance = 1e-12;
  settings.projections_every = 3;
  ReferenceSimulation simulation(scene.model, settings);
  settings.projections_every = 1;
  settings.projections = Projections::none;
  ReferenceSimulation unprojected(scene.model, settings);
  simulation.set_state(initial_state(scene.model));
  unprojected.set_state(initial_state(scene.model));
  State state, other;
  for (int i = 1; i <= 3; ++i) {
    (void)simulation.step();
    (void)unprojected.step();
    simulation.get_state(state);
    unprojected.get_state(other);
    EXPECT_EQ(distance_between(state.v, other.v) == 0.0, i < 3) << i;
  }
}

}  // namespace
}  // namespace mbs
