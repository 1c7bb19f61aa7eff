// What a judge says of single states: lost, on another branch, or sound.
#include "run/judge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "model_math/kinematics.hpp"
#include "run/constraint_values.hpp"
#include "run/initial_state.hpp"
#include "run/stretch.hpp"
#include "scene_file/load_scene.hpp"
#include "support/sample_models.hpp"

namespace mbs {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

TEST(Judge, RefusesANanAnywhere) {
  const Scene scene = load_scene("four-bar:2");
  const State initial = make_stretch(scene, 1.25e-3, 1, 0.0).initial;
  EXPECT_EQ(Judge(scene, initial, 0.0).judge(0.0, initial), "");
  for (const auto quantity : {&State::q, &State::v, &State::a, &State::lambda}) {
    for (const double bad : {kNotANumber, HUGE_VAL, -HUGE_VAL}) {
      for (std::size_t i = 0; i < (initial.*quantity).size(); ++i) {
        State state = initial;
        (state.*quantity)[i] = bad;
        EXPECT_EQ(Judge(scene, initial, 0.0).judge(0.0, state), "the state is not finite");
      }
    }
  }
}

TEST(Judge, EvaluatesConstraintsFromItsListAsTheModelSays) {
  for (const std::string name :
       {"four-bar:3", "loop:6", MBS_ROOT "/harness/scenes/examples/spatial_pendulum.json",
        MBS_ROOT "/harness/scenes/examples/driven_crank.json",
        MBS_ROOT "/harness/scenes/problems/spatial_slider_crank.json"}) {
    const Scene scene = load_scene(name);
    const Model& model = scene.model;
    std::vector<double> q = initial_state(model).q;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += 0.1 * std::sin(1.0 + 2.0 * i);
    std::vector<double> expected(static_cast<std::size_t>(model.constraints())), phi = expected;
    evaluate_constraints(model, 0.3, q, expected);
    ConstraintValues(model).evaluate(0.3, q, phi);
    for (std::size_t k = 0; k < phi.size(); ++k) {
      EXPECT_NEAR(phi[k], expected[k], 1e-14) << name << " " << k;
    }
    q.push_back(0.0);
    EXPECT_THROW(ConstraintValues(model).evaluate(0.3, q, phi), std::invalid_argument) << name;
  }
}

TEST(Judge, NamesWhatIsLost) {
  const Scene scene = load_scene("four-bar:2");
  const State initial = make_stretch(scene, 1.25e-3, 1, 0.0).initial;
  State state = initial;
  state.q[0] += 0.2;
  Judge position(scene, initial, 0.0);
  EXPECT_TRUE(position.judge(0.0, state).starts_with("position error 2.00e-01 m"));
  EXPECT_NEAR(*position.position_error_max(), 0.2, 1e-12);
  state = initial;
  state.q[1] += 0.05;
  const std::string violated = Judge(scene, initial, 0.0).judge(0.0, state);
  EXPECT_TRUE(violated.starts_with("constraints violated by")) << violated;
  EXPECT_TRUE(violated.ends_with(", A0-B0 most")) << violated;
  Judge degraded(scene, initial, 0.0);
  EXPECT_FALSE(degraded.is_degraded());
  for (const int i : {1, 3}) {  // of B0 and, less, of B1
    state = initial;
    state.q[static_cast<std::size_t>(i)] += 5e-4 / i;
    EXPECT_EQ(degraded.judge(0.0, state), "");
  }
  EXPECT_TRUE(degraded.is_degraded());
  EXPECT_TRUE(degraded.degradation().ends_with(" (ok to 0.0001), most of A0-B0"))
      << degraded.degradation();
  state = initial;
  for (double& velocity : state.v) velocity *= 3.0;
  EXPECT_TRUE(Judge(scene, initial, 0.0).judge(0.0, state).starts_with("energy drifted by"));
}

// From A1 a rod of 1 m reaches A0 too: with B1 there, all lengths hold for any B0.
TEST(Judge, TellsAnotherBranchFromALateMotion) {
  const Scene scene = load_scene("four-bar:1");
  const State initial = make_stretch(scene, 1.25e-3, 1, 0.0).initial;
  const double cosine = std::sqrt(0.75), sine = 0.5;
  State state = initial;
  const auto with_energy = [&](std::vector<double> q, std::vector<double> v) {
    state.q = std::move(q);
    const Model& model = scene.model;
    const double wanted =
        energy(model, 0.0, initial.q, initial.v) - potential_energy(model, 0.0, state.q);
    const double factor = std::sqrt(wanted / kinetic_energy(model, v));
    for (double& value : v) value *= factor;
    state.v = std::move(v);
    Judge judge(scene, initial, 0.0);
    const std::string lost = judge.judge(0.0, state);
    return std::pair(judge.off_branch(), lost);
  };
  const auto [other, parallel] = with_energy({cosine, sine, 0.0, 0.0}, {sine, -cosine, 0.0, 0.0});
  EXPECT_TRUE(other) << parallel;
  EXPECT_TRUE(parallel.starts_with("rods that are parallel differ by")) << parallel;
  const auto [same, late] =
      with_energy({cosine, sine, 1 + cosine, sine}, {sine, -cosine, sine, -cosine});
  EXPECT_FALSE(same);
  EXPECT_TRUE(late.starts_with("position error")) << late;
}

/// Stretched by 0.5 m; `damping` in N s/m.
Scene spring_mass(double damping) { return test::oscillator(100.0, damping, 1.0, 1.5); }

State at(double x, double vx) { return {{x, 0}, {vx, 0}, {0, 0}, {}, 0.0}; }

TEST(Judge, JudgesEnergyOfConservativeModelsOnly) {
  const Scene conservative = spring_mass(0.0), damped = spring_mass(5.0);
  Judge strict(conservative, at(1.5, 0.0), 0.0);
  EXPECT_EQ(strict.judge(0.1, at(1.0, 5.0)), "");  // 100 * 0.5^2 / 2 J either way
  EXPECT_NEAR(*strict.energy_drift_max(), 0.0, 1e-12);
  EXPECT_TRUE(strict.judge(0.2, at(1.0, 3.0)).starts_with("energy drifted by"));
  Judge lenient(damped, at(1.5, 0.0), 0.0);
  EXPECT_EQ(lenient.judge(0.2, at(1.0, 3.0)), "");
  EXPECT_FALSE(lenient.energy_drift_max());
  State lost = at(1.0, 3.0);
  lost.v[1] = kNotANumber;
  EXPECT_EQ(lenient.judge(0.2, lost), "the state is not finite");
}

TEST(Judge, ALightPartIsJudgedByItsOwnEnergy) {
  ModelData data;  // two masses that fly freely, one a millionth of the other
  data.points = {{"heavy", 0, {0, 0, 0}}, {"light", 2, {0, 1, 0}}};
  data.mass = {{0, 0, 1.0}, {1, 1, 1.0}, {2, 2, 1e-6}, {3, 3, 1e-6}};
  data.force = {0.0, 0.0, 0.0, 0.0};
  data.initial_velocity = {1.0, 0.0, 1.0, 0.0};
  const Scene scene{"two", Model(std::move(data)), {}, {}};
  const auto state = [](double light) {
    return State{{0, 0, 0, 1}, {1, 0, light, 0}, {0, 0, 0, 0}, {}, 0.0};
  };
  Judge judge(scene, state(1.0), 0.0);
  EXPECT_EQ(judge.judge(0.1, state(1.001)), "");
  EXPECT_EQ(judge.degradation(), "");
  EXPECT_EQ(judge.judge(0.2, state(1.02)), "");
  EXPECT_TRUE(judge.degradation().starts_with("energy drift of a part")) << judge.degradation();
  EXPECT_TRUE(judge.degradation().ends_with(", that of light")) << judge.degradation();
  EXPECT_LT(*judge.energy_drift_max(), 1e-6);
  EXPECT_TRUE(judge.judge(0.3, state(1.2)).starts_with("energy of a part drifted"));
}

TEST(Judge, WithDampersAloneEnergyNeverGrows) {
  const auto scene = [](double c0, double c1) {  // the force of c0 + c1 L' beside the spring
    Scene result = spring_mass(0.0);
    ModelData data = result.model.data();
    Law law;
    law.by_rate.breaks = {-1.0, 1.0};
    law.by_rate.pieces.assign(3, {0.0, {c0, c1, 0.0, 0.0}});
    data.force_laws.push_back({data.springs[0].a, data.springs[0].b, law, "law"});
    result.model = Model(std::move(data));
    return result;
  };
  const auto judged = [](const Scene& scene, double vx) {  // of 12.5 J
    Judge judge(scene, at(1.5, 0.0), 0.0);
    EXPECT_EQ(judge.judge(0.1, at(1.0, 4.0)), "");
    const std::string lost = judge.judge(0.2, at(1.0, vx));
    return lost.empty() ? judge.degradation() : lost;
  };
  for (const Scene& damped : {spring_mass(5.0), scene(0.0, 5.0)}) {
    EXPECT_EQ(judged(damped, 3.9), "");
    EXPECT_TRUE(judged(damped, 4.1).starts_with("energy drift of a part"));
    EXPECT_TRUE(judged(damped, 5.0).starts_with("energy of a part drifted"));
  }
  // What drives, and a force at rest that is no potential, bring energy.
  for (const Scene& driven : {scene(0.0, -5.0), scene(1.0, 5.0)})
    EXPECT_EQ(judged(driven, 5.0), "");
}

TEST(Judge, ASpringAtRestGivesTheEnergyScale) {
  const Scene scene = spring_mass(0.0);
  // At the first step hardly anything moves: the drift is small against what the spring holds.
  Judge judge(scene, at(1.5, 0.0), 0.0);
  EXPECT_EQ(judge.judge(1e-6, at(1.5, 1e-4)), "");
}

TEST(Judge, RoundingIsNoEnergy) {
  ModelData data;  // a balanced body: what is left of its weight is rounding
  data.points = {{"A", -1, {0, 0, 0}}, {"B", 0, {1, 0, 0}}};
  data.mass = {{0, 0, 0.2}, {1, 1, 0.2}};
  data.force = {0.0, 2e-17};
  data.initial_velocity = {0.0, 0.0};
  data.dot_constraints = {{0, 1, 0, 1, 1.0, "body"}};
  const Scene scene{"balanced", Model(std::move(data)), {}, {}};
  const State start{{1, 0}, {0, 0}, {0, 0}, {0}, 0.0};
  Judge judge(scene, start, 0.0);
  EXPECT_EQ(judge.judge(1.0, {{1, 0}, {0, 1e-12}, {0, 0}, {0}, 1.0}), "");
  EXPECT_NE(judge.judge(1.0, {{1, 0}, {0, 1e-2}, {0, 0}, {0}, 1.0}), "");
}

/// A rod of 1 m from A along x, on a torsion spring that is free at `angle`.
Scene on_torsion_spring(double stiffness, double angle) {
  ModelData data;
  data.points = {{"A", -1, {0, 0, 0}}, {"X", -1, {1, 0, 0}}, {"B", 0, {1, 0, 0}}};
  data.mass = {{0, 0, 1.0}, {1, 1, 1.0}};
  data.force = data.initial_velocity = {0.0, 0.0};
  data.torsion_springs.push_back({1, 0, 2, 0, -1, stiffness, 1.0, angle, "clock"});
  data.couples.push_back({2, 0, -1, 1.0, "motor"});  // energy may grow
  return {"torsion", Model(std::move(data)), {}, {}};
}

TEST(Judge, ATorsionSpringEndsHalfATurnFromItsFreeAngle) {
  const auto turned = [](double angle) {
    return State{{std::cos(angle), std::sin(angle)}, {0, 0}, {0, 0}, {}, 0.0};
  };
  const Scene scene = on_torsion_spring(1.0, 0.5), damper = on_torsion_spring(0.0, 0.5);
  Judge judge(scene, turned(0.0), 0.0), lenient(damper, turned(0.0), 0.0);
  for (const double angle : {1.0, 2.0, 3.0, 3.6}) {
    EXPECT_EQ(judge.judge(angle, turned(angle)), "");
    EXPECT_EQ(lenient.judge(angle, turned(angle)), "");
  }
  const std::string lost = judge.judge(3.7, turned(3.7));
  EXPECT_TRUE(lost.starts_with("clock: it is more than half a turn from its free angle")) << lost;
  EXPECT_EQ(lenient.judge(3.7, turned(3.7)), "");  // without stiffness there is no such angle
}

TEST(Judge, ATorsionSpringStaysAcrossItsAxis) {
  ModelData data;
  data.dimension = 3;
  data.points = {
      {"A", -1, {0, 0, 0}}, {"X", -1, {1, 0, 0}}, {"z", -1, {0, 0, 1}, true}, {"B", 0, {0, 1, 0}}};
  for (int i = 0; i < 3; ++i) data.mass.push_back({i, i, 1.0});
  data.force = data.initial_velocity = {0.0, 0.0, 0.0};
  data.torsion_springs.push_back({1, 0, 3, 0, 2, 1.0, 1.0, 1.5, "hinge"});
  const Scene scene{"torsion", Model(std::move(data)), {}, {}};
  const auto lifted = [](double z) { return State{{0, 1, z}, {0, 0, 0}, {0, 0, 0}, {}, 0.0}; };
  Judge judge(scene, lifted(0.0), 0.0);
  EXPECT_EQ(judge.judge(0.1, lifted(0.009)), "");
  EXPECT_TRUE(judge.judge(0.2, lifted(0.011)).starts_with("hinge: its axis is not perpendicular"));
  ModelData turned = scene.model.data();
  turned.torsion_springs.clear();
  turned.couples.push_back({3, 0, 2, 0.5, "drive"});
  const Scene driven{"couple", Model(std::move(turned)), {}, {}};
  Judge other(driven, lifted(0.0), 0.0);
  EXPECT_EQ(other.judge(0.1, lifted(0.009)), "");
  EXPECT_TRUE(other.judge(0.2, lifted(0.011)).starts_with("drive: its axis is not perpendicular"));
}

TEST(Judge, ScalesLinearAndBilinearConstraints) {
  ModelData data;
  data.points = {{"A", -1, {0, 0, 0}}, {"B", 0, {2, 0, 0}}, {"C", 2, {4, 0, 0}}};
  for (int i = 0; i < 4; ++i) data.mass.push_back({i, i, 1.0});
  data.force = data.initial_velocity = {0.0, 0.0, 0.0, 0.0};
  data.bilinear_constraints.push_back({1, 0, 2, 0, {{{0, 1, 0}, {-1, 0, 0}, {}}}, 0.0, "parallel"});
  data.linear_constraints = {{{{1, 5.0}}, 0.0, "rail"}};
  const Scene scene{"test", Model(std::move(data)), {}, {}};
  const State start{{2, 0, 4, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0}, 0.0};
  const auto verdict = [&](double b_y, double c_y) {
    State state = start;
    state.q[1] = b_y;
    state.q[3] = c_y;
    return Judge(scene, start, 0.0).judge(0.0, state);
  };
  EXPECT_EQ(verdict(0.0, 0.03), "");  // Phi = 2 * 0.03 of |u| |w| = 8
  EXPECT_TRUE(verdict(0.0, 0.05).starts_with("constraints violated by 1.25e-02"));
  EXPECT_EQ(verdict(0.03, 0.06), "");  // Phi = 5 * 0.03 of 5 * 4 m
  EXPECT_TRUE(verdict(0.05, 0.1).starts_with("constraints violated by 1.25e-02"));
}

}  // namespace
}  // namespace mbs
