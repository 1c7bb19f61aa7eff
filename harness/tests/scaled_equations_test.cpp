// Constraints that weigh alike: the factors, and that the motion and the multipliers stay.
#include "run/scaled_equations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "controls/controls.hpp"
#include "controls/wrapped_reference.hpp"
#include "registry/factory.hpp"
#include "registry/registry.hpp"
#include "run/initial_state.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/sample_models.hpp"
#include "support/term_models.hpp"

namespace mbs {
namespace {

TEST(ScaledEquations, BringTheDiagonalTogether) {
  ModelData data = four_bar(4);
  for (MassEntry& entry : data.mass) {
    if (entry.row / 2 == 2 || entry.col / 2 == 2) entry.value *= entry.row == entry.col ? 1e6 : 1.0;
  }
  const Model model(std::move(data));
  const auto spread = [](const Model& m) {
    const std::vector<double> diagonal = constraint_diagonal(m);
    return *std::ranges::max_element(diagonal) / *std::ranges::min_element(diagonal);
  };
  const ScaledEquations scaled(model);
  EXPECT_GT(spread(model), 1e4);
  EXPECT_LE(spread(scaled.model()), 4.0);
  for (const double factor : scaled.factors()) {
    EXPECT_EQ(std::exp2(std::round(std::log2(factor))), factor);
  }
}

// In the saddle-point form eps hardly matters: all terms move as before, multipliers too.
TEST(ScaledEquations, LeaveEveryTermsMotionAndMultipliers) {
  for (const TermModel& term : term_models()) {
    SCOPED_TRACE(term.name);
    StepSettings settings;
    settings.step = 2.5e-4;
    settings.scheme = Scheme::saddle_point;
    settings.tolerance = 1e-15;
    settings.penalty = automatic_penalty(term.model, settings);
    const ScaledEquations scaled(term.model);
    const auto plain = create_simulation(test::reference(), term.model, settings);
    settings.penalty = automatic_penalty(scaled.model(), settings);
    const auto other = scaled.create(test::reference(), term.model, settings);
    State state = initial_state(term.model), same = state;
    plain->set_state(state);
    other->set_state(state);
    for (int i = 0; i < 20; ++i) {
      ASSERT_NE(plain->step().status, StepStatus::factorization_failed);
      ASSERT_NE(other->step().status, StepStatus::factorization_failed);
    }
    plain->get_state(state);
    other->get_state(same);
    double largest = 1.0;
    for (const double x : state.lambda) largest = std::max(largest, std::abs(x));
    for (std::size_t i = 0; i < state.q.size(); ++i) EXPECT_NEAR(state.q[i], same.q[i], 1e-9);
    for (std::size_t k = 0; k < state.lambda.size(); ++k) {
      EXPECT_NEAR(state.lambda[k], same.lambda[k], 1e-3 * largest) << k;
    }
  }
}

/// Looks at its model when it ends, too.
class Lasting final : public test::WrappedReference {
 public:
  static inline int good = 0, bad = 0;
  Lasting(const Model& model, const StepSettings& settings)
      : WrappedReference(model, settings), model_(model) {}
  ~Lasting() override { ++(model_.dimension() == 2 ? good : bad); }

 private:
  const Model& model_;
};

TEST(ScaledEquations, OutliveAllSimulationsOfARun) {
  const Scene scene = load_scene(MBS_ROOT "/harness/scenes/double_pendulum.json");
  Variant variant = test::reference();
  variant.create = [](const Model& model,
                      const StepSettings& settings) -> std::unique_ptr<Simulation> {
    return std::make_unique<Lasting>(model, settings);
  };
  RunSettings settings;
  settings.duration = 0.25;
  settings.scale_equations = true;
  settings.step.penalty = automatic_penalty(ScaledEquations(scene.model).model(), settings.step);
  settings.step.tolerance = 1e-6;  // so loose that the judge does steps again
  run(scene, variant, settings);
  EXPECT_EQ(Lasting::good, 2);
  EXPECT_EQ(Lasting::bad, 0);
}

TEST(ScaledEquations, AreStepsOfTheJudgeToo) {
  static int plain = 0;
  const Scene scene = load_scene(MBS_ROOT "/harness/scenes/point_mass_pendulum.json");
  Variant variant = test::reference();
  variant.create = [](const Model& model, const StepSettings& settings) {
    if (!model.dot_constraints().empty()) ++plain;
    return test::reference().create(model, settings);
  };
  RunSettings settings;
  settings.duration = 0.1;
  settings.scale_equations = true;
  settings.step = chosen(ScaledEquations(scene.model).model(), {.scheme = Scheme::rattle4});
  settings.half_step = settings.step;
  settings.half_step->step /= 2;
  EXPECT_EQ(run(scene, variant, settings).status, RunStatus::ok);
  EXPECT_EQ(plain, 0);
}

// Two masses go round on rods, one of them of 1000 t: its constraint is multiplied by 512 or so.
TEST(ScaledEquations, SayThatRoundingDrownsTheForcesAsTheyAre) {
  const Scene scene = scene_of(nlohmann::json::parse(R"({"gravity": [0, 0], "points": [
      {"name": "O", "position": [0, 0], "fixed": true},
      {"name": "A", "position": [1, 0], "velocity": [0, 1]},
      {"name": "B", "position": [0, 1], "velocity": [1, 0]}],
    "rods": [{"name": "light", "between": ["O", "A"], "mass": 0}, {"name": "heavy", "between": ["O", "B"], "mass": 0}],
    "masses": [{"point": "A", "mass": 1}, {"point": "B", "mass": 1e6}],
    "outputs": [{"name": "T", "constraint_force": "heavy"}]})"),
                               "test");
  const ScaledEquations scaled(scene.model);
  const double factor = scaled.factors()[1];
  EXPECT_GT(factor, 100.0);
  const auto drowns = [&](double share) {
    RunSettings settings;
    settings.scale_equations = true;
    settings.duration = 0.01;
    // alpha (2 factor)^2 epsilon of the 1e6 N that turn the heavy one
    settings.step.penalty = share * 1e6 / (4 * factor * factor * 2.2e-16);
    settings.step.tolerance = 1e-9;
    const NamedVariant variant = select_variants({"eigen_dense/llt"}).front();  // in double
    return !run(scene, *variant.variant, settings).forces_lost.empty();
  };
  EXPECT_FALSE(drowns(1e-3));
  EXPECT_TRUE(drowns(10.0));
}

TEST(ScaledEquations, AreASettingOfARun) {
  const Scene scene = load_scene("four-bar:3");
  RunSettings settings;
  settings.duration = 1.0;
  settings.scale_equations = true;
  settings.step = chosen(ScaledEquations(scene.model).model());
  const RunSummary summary = run(scene, test::reference(), settings);
  EXPECT_EQ(summary.status, RunStatus::ok) << summary.reason;
  EXPECT_LT(*summary.position_error_max, 1e-4);
}

}  // namespace
}  // namespace mbs
