// Laws of forces and torques: what they equal, closed forms, independent integration, judgement.
#include <gtest/gtest.h>

#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "model_math/kinematics.hpp"
#include "model_math/monotone_curve.hpp"
#include "reference/reference_simulation.hpp"
#include "registry/factory.hpp"
#include "registry/registry.hpp"
#include "run/driver_end.hpp"
#include "run/initial_state.hpp"
#include "run/judge.hpp"
#include "run/settings.hpp"
#include "support/boost_pchip.hpp"
#include "support/scene_support.hpp"

namespace mbs {
namespace {

using Create = std::function<std::unique_ptr<Simulation>(const Model&, const StepSettings&)>;

/// The reference and every variant that serves laws.
std::vector<std::pair<std::string, Create>> simulations() {
  std::vector<std::pair<std::string, Create>> result{
      {"reference", [](const Model& model, const StepSettings& settings) {
         return std::make_unique<ReferenceSimulation>(model, settings);
       }}};
  for (const NamedVariant& one : all_variants()) {
    if (!one.variant->serves.terms.has(Term::force_laws)) continue;
    result.emplace_back(one.name, [variant = one.variant](const auto& model, const auto& settings) {
      return create_simulation(*variant, model, settings);
    });
  }
  return result;
}

StepSettings settings_for(const Model& model, double step) {
  StepSettings settings;
  settings.step = step;
  settings.penalty = automatic_penalty(model, settings);
  settings.tolerance = 1e-11;
  return settings;
}

/// The state after so many steps; the most passes that a step took to `passes`.
State run(const Create& create, const Model& model, double step, int steps, int* passes = nullptr) {
  const auto simulation = create(model, settings_for(model, step));
  State state = initial_state(model);
  simulation->set_state(state);
  for (int i = 0; i < steps; ++i) {
    const StepOutcome outcome = simulation->step();
    EXPECT_EQ(outcome.status, StepStatus::converged);
    if (passes != nullptr) *passes = std::max(*passes, outcome.passes);
  }
  simulation->get_state(state);
  return state;
}

/// A mass on the x axis, at `x` from a fixed point with velocity `v`, under a law between them.
Model on_a_line(double mass, double x, double v, Law law) {
  ModelData data;
  data.points = {{"A", -1, {0.0, 0.0}}, {"B", 0, {x, 0.0}}};
  data.mass = {{0, 0, mass}, {1, 1, mass}};
  data.force = {0.0, 0.0};
  data.initial_velocity = {v, 0.0};
  data.force_laws = {{1, 0, std::move(law), "law"}};
  return Model(std::move(data));
}

/// Two masses that hang on springs, or on laws with tables of two rows that say the same.
Model hanging(bool on_laws) {
  ModelData data;
  data.points = {{"A", -1, {0.0, 0.0}}, {"B", 2, {0.9, -0.3}}, {"C", 0, {1.5, 0.4}}};
  for (int i = 0; i < 4; ++i) data.mass.push_back({i, i, i < 2 ? 1.3 : 0.8});
  data.force = {0.0, -5.0, 0.0, -4.0};
  data.initial_velocity = {0.3, -0.2, 0.1, 0.4};
  data.springs = {{1, 0, 300.0, 4.0, 0.7, "s"}, {2, 1, 200.0, 2.0, 1.4, "t"}};
  data.torsion_springs = {{1, 0, 2, 1, -1, 12.0, 0.8, 0.4, "hinge"}};
  if (!on_laws) return Model(std::move(data));
  const auto law = [](double stiffness, double damping, double rest) {
    const double x0 = rest - 0.3, x1 = rest + 0.2;
    return Law{monotone_curve({x0, x1}, {stiffness * (x0 - rest), stiffness * (x1 - rest)}),
               monotone_curve({-0.1, 0.2}, {damping * -0.1, damping * 0.2})};
  };
  for (const Spring& s : data.springs) {
    data.force_laws.push_back({s.a, s.b, law(s.stiffness, s.damping, s.length), s.name});
  }
  for (const TorsionSpring& s : data.torsion_springs) {
    data.torque_laws.push_back(
        {s.a, s.b, s.c, s.d, s.axis, law(s.stiffness, s.damping, s.angle), s.name});
  }
  data.springs.clear();
  data.torsion_springs.clear();
  return Model(std::move(data));
}

TEST(ForceLaw, StraightTablesAreSpringsAndDampers) {
  const Model springs = hanging(false), laws = hanging(true);
  for (const auto& [name, create] : simulations()) {
    SCOPED_TRACE(name);
    int spring_passes = 0, law_passes = 0;
    const State expected = run(create, springs, 5e-3, 200, &spring_passes);
    const State state = run(create, laws, 5e-3, 200, &law_passes);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(state.q[i], expected.q[i], 1e-12) << i;
    EXPECT_EQ(law_passes, spring_passes);  // the same tangent
  }
}

/// m x'' = -k z^3 from rest at z = A is z = A cn(sqrt(k/m) A t, 1/sqrt(2)).
TEST(ForceLaw, CubicForceMovesByTheEllipticCosine) {
  const double mass = 2.0, stiffness = 8.0, amplitude = 0.5, rest = 2.0, time = 5.0;
  Law law;
  law.by_position = {{rest}, {{rest, {0, 0, 0, stiffness}}, {rest, {0, 0, 0, stiffness}}}};
  const Model model = on_a_line(mass, rest + amplitude, 0.0, law);
  const double rate = std::sqrt(stiffness / mass) * amplitude;
  const double exact = rest + amplitude * boost::math::jacobi_cn(std::sqrt(0.5), rate * time);
  for (const auto& [name, create] : simulations()) {
    SCOPED_TRACE(name);
    const State fine = run(create, model, 5e-3, 1000), coarse = run(create, model, 1e-2, 500);
    const double error = fine.q[0] - exact;
    EXPECT_LT(std::abs(error), 2e-5);
    EXPECT_NEAR((coarse.q[0] - exact) / error, 4.0, 0.1);  // second order
    EXPECT_EQ(fine.q[1], 0.0);
    const Scene scene{"cubic", model, {}, {}};
    Judge judge(scene, initial_state(model), 0.0);
    EXPECT_EQ(judge.judge(time, fine), "");
    ASSERT_TRUE(judge.energy_drift_max().has_value());
    EXPECT_LT(*judge.energy_drift_max(), 1e-4);
    EXPECT_NEAR(energy(model, 0.0, model.initial_position(), model.initial_velocity()),
                stiffness / 4 * std::pow(amplitude, 4), 1e-15);
  }
}

/// Slopes weigh as much as the inertia here. If the part that the cubic term has of them, a third,
/// were missing, Newton would come nearer by a constant factor a pass, and take more than ten.
TEST(ForceLaw, NewtonConvergesQuadratically) {
  Law stiff, thick;
  const Curve::Piece in_length{1.0, {0, 3e4, 0, 5e5}}, in_rate{0.0, {0, 150, 0, 3}};
  stiff.by_position = {{1.0}, {in_length, in_length}};
  thick.by_rate = {{0.0}, {in_rate, in_rate}};
  for (const auto& [name, create] : simulations()) {
    SCOPED_TRACE(name);
    for (const Model& model : {on_a_line(1.0, 1.1, 0.0, stiff), on_a_line(1.0, 1.1, 3.0, thick)}) {
      int passes = 0;
      run(create, model, 1e-2, 20, &passes);
      EXPECT_LE(passes, 5);
    }
  }
}

const char* const kTables = R"(
  "by_rate": {"rates": [-2, -0.5, 0, 0.5, 2], "VALUES": [-3, -1.5, 0, 2, 4]},
  "factor": {"sine": {"amplitude": 0.5, "frequency": 0.7, "phase": 0.2, "offset": 1}}})";

std::string tables(const std::string& values) {
  std::string text = kTables;
  return text.replace(text.find("VALUES"), 6, values);
}

/// m s'' = -F of the tables above, by the classical Runge-Kutta method and Boost's interpolation.
double integrated(double mass, const std::vector<double>& x, const std::vector<double>& y, double s,
                  double rate, double time) {
  const auto held = test::boost_pchip(x, y);
  const auto free = test::boost_pchip({-2, -0.5, 0, 0.5, 2}, {-3, -1.5, 0, 2, 4});
  const auto a = [&](double t, double position, double speed) {
    const double factor = 1 + 0.5 * std::sin(2 * std::numbers::pi * 0.7 * t + 0.2);
    return -factor * (held(position) + free(speed)) / mass;
  };
  const int steps = 100000;
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const double v1 = rate, a1 = a(t, s, v1);
    const double v2 = rate + h / 2 * a1, a2 = a(t + h / 2, s + h / 2 * v1, v2);
    const double v3 = rate + h / 2 * a2, a3 = a(t + h / 2, s + h / 2 * v2, v3);
    const double v4 = rate + h * a3, a4 = a(t + h, s + h * v3, v4);
    s += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    rate += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return s;
}

void expect_integrated(const std::string& json, double exact,
                       const std::function<double(const State&)>& measure) {
  const Model model(parse_scene(json, "test.json").model);
  EXPECT_FALSE(is_conservative(model));
  const Scene scene{"test", model, {}, {}};
  for (const auto& [name, create] : simulations()) {
    SCOPED_TRACE(name);
    const State end = run(create, model, 1e-3, 2000);
    EXPECT_NEAR(measure(end), exact, 2e-6);
    Judge judge(scene, initial_state(model), 0.0);
    EXPECT_EQ(judge.judge(2.0, end), "");
    EXPECT_FALSE(judge.energy_drift_max().has_value());  // never drift: nothing conserves it
  }
}

TEST(ForceLaw, TablesAlongALineAgreeWithAnotherIntegration) {
  expect_integrated(R"({"gravity": [0, 0], "points": [
      {"name": "A", "position": [0, 0], "fixed": true},
      {"name": "B", "position": [1.3, 0], "velocity": [0.4, 0]}],
    "masses": [{"point": "B", "mass": 0.5}],
    "force_laws": [{"between": ["A", "B"],
      "by_length": {"lengths": [0.2, 0.8, 1, 1.1, 2], "forces": [-9, -1, 0, 1, 12]},)" +
                        tables("forces") + "]}",
                    integrated(0.5, {0.2, 0.8, 1, 1.1, 2}, {-9, -1, 0, 1, 12}, 1.3, 0.4, 2.0),
                    [](const State& state) { return state.q[0]; });
}

TEST(ForceLaw, TablesAboutAnAxisAgreeWithAnotherIntegration) {
  expect_integrated(R"({"gravity": [0, 0], "points": [
      {"name": "A", "position": [0, 0], "fixed": true},
      {"name": "X", "position": [1, 0], "fixed": true},
      {"name": "B", "position": [2, 0], "velocity": [0, 0.8]}],
    "masses": [{"point": "B", "mass": 0.125}],
    "rods": [{"between": ["A", "B"], "mass": 0}],
    "torque_laws": [{"from": ["A", "X"], "to": ["A", "B"],
      "by_angle": {"angles": [-2, -0.3, 0, 0.1, 2], "torques": [-9, -1, 0, 1, 12]},)" +
                        tables("torques") + "]}",
                    integrated(0.5, {-2, -0.3, 0, 0.1, 2}, {-9, -1, 0, 1, 12}, 0.0, 0.4, 2.0),
                    [](const State& state) { return std::atan2(state.q[1], state.q[0]); });
}

/// A rod of 1 m from A along x under a torque law.
Scene on_torque_law(Law law) {
  ModelData data;
  data.points = {{"A", -1, {0, 0, 0}}, {"X", -1, {1, 0, 0}}, {"B", 0, {1, 0, 0}}};
  data.mass = {{0, 0, 1.0}, {1, 1, 1.0}};
  data.force = data.initial_velocity = {0.0, 0.0};
  data.torque_laws.push_back({1, 0, 2, 0, -1, std::move(law), "clock"});
  return {"law", Model(std::move(data)), {}, {}};
}

TEST(ForceLaw, OverAnAngleItEndsHalfATurnFromZero) {
  const auto turned = [](double angle) {
    return State{{std::cos(angle), std::sin(angle)}, {0, 0}, {0, 0}, {}, 0.0};
  };
  const Curve line = monotone_curve({-1.0, 1.0}, {-1.0, 1.0});
  const Curve drives = monotone_curve({-1.0, 1.0}, {1.0, -1.0});  // so that energy may grow
  const Scene held = on_torque_law({line, drives}), motor = on_torque_law({{}, drives});
  Judge judge(held, turned(0.0), 0.0), lenient(motor, turned(0.0), 0.0);
  for (const double angle : {1.5, 3.1}) EXPECT_EQ(judge.judge(angle, turned(angle)), "");
  const std::string lost = judge.judge(3.2, turned(3.2));
  EXPECT_TRUE(lost.starts_with("clock: it is more than half a turn from the angle 0")) << lost;
  for (const double angle : {1.5, 3.1, 4.6, 7.0}) {
    EXPECT_EQ(lenient.judge(angle, turned(angle)), "");  // a motor turns on
  }
}

TEST(ForceLaw, ItsFactorEndsWithItsTable) {
  const SceneData data =
      parse_scene(R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
      {"name": "B", "position": [1, 0]}], "masses": [{"point": "B", "mass": 1}],
    "force_laws": [{"between": ["A", "B"], "by_length": {"lengths": [0, 1], "forces": [0, 1]},
      "factor": {"table": {"times": [0, 0.1, 0.2, 0.3], "values": [0, 1, 2, 3]}}}]})",
                  "test.json");
  const Scene scene{"test.json", Model(data.model), {}, {}, data.elements};
  EXPECT_EQ(driver_end(scene.model), 0.3);
  EXPECT_NO_THROW(require_drivers(scene, 0.1, 3));
  EXPECT_THROW(require_drivers(scene, 0.1, 4), UsageError);
  EXPECT_THROW(require_drivers(scene, 0.15, 2), UsageError);
}

}  // namespace
}  // namespace mbs
