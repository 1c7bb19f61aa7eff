// Each kind of output on a state that is known.
#include "run/output_values.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model_math/kinematics.hpp"
#include "support/sample_models.hpp"

namespace mbs {
namespace {

constexpr Marker::Part half_of(int point) {
  return {point, {{{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}}};
}

/// Columns and values of one output on `state`.
std::vector<double> values_of(Scene scene, const Output& output, double t, const State& state,
                              std::vector<std::string> columns) {
  scene.elements.outputs = {output};
  OutputValues values(scene);
  EXPECT_EQ(values.columns(), columns);
  values.follow(t, state);
  return values.values();
}

/// The free fall's two points at rest at (3, 0) and (0, 4) but for P's velocity.
State planar_state() { return {{3, 0, 0, 4}, {1, 2, 0, 0}, {0, -9, 5, 0}, {}, 0.0}; }

TEST(OutputValues, GivesMotionOfPoints) {
  const Scene scene = test::free_fall();
  const State state = planar_state();
  using Values = std::vector<double>;
  EXPECT_EQ(values_of(scene, {"p", Output::Kind::position, 0}, 0, state, {"p.x", "p.y"}),
            (Values{3, 0}));
  EXPECT_EQ(values_of(scene, {"p", Output::Kind::velocity, 0}, 0, state, {"p.vx", "p.vy"}),
            (Values{1, 2}));
  EXPECT_EQ(values_of(scene, {"r", Output::Kind::acceleration, 1}, 0, state, {"r.ax", "r.ay"}),
            (Values{5, 0}));
}

TEST(OutputValues, GivesMotionOfMarkers) {
  Scene scene = test::free_fall();
  scene.elements.markers.push_back({"middle", {half_of(0), half_of(1)}});
  const State state = planar_state();
  using Values = std::vector<double>;
  EXPECT_EQ(values_of(scene, {"m", Output::Kind::position, 2}, 0, state, {"m.x", "m.y"}),
            (Values{1.5, 2}));
  EXPECT_EQ(values_of(scene, {"m", Output::Kind::velocity, 2}, 0, state, {"m.vx", "m.vy"}),
            (Values{0.5, 1}));
  EXPECT_EQ(values_of(scene, {"m", Output::Kind::acceleration, 2}, 0, state, {"m.ax", "m.ay"}),
            (Values{2.5, -4.5}));
}

TEST(OutputValues, GivesDistancesAndEnergies) {
  const Scene scene = test::free_fall();
  const State state = planar_state();
  Output distance{"d", Output::Kind::distance};
  distance.first = {0, 1};
  EXPECT_EQ(values_of(scene, distance, 0, state, {"d"})[0], 5.0);
  const double kinetic = kinetic_energy(scene.model, state.v);
  const double potential = potential_energy(scene.model, 0.0, state.q);
  EXPECT_EQ(values_of(scene, {"k", Output::Kind::kinetic_energy}, 0, state, {"k"})[0], kinetic);
  EXPECT_EQ(values_of(scene, {"p", Output::Kind::potential_energy}, 0, state, {"p"})[0], potential);
  EXPECT_EQ(values_of(scene, {"e", Output::Kind::total_energy}, 0, state, {"e"})[0],
            kinetic + potential);
  EXPECT_EQ(kinetic, 5.0);
}

TEST(OutputValues, AnglesCountTurns) {
  ModelData data;
  data.points = {{"A", -1, {0, 0, 0}}, {"E", -1, {1, 0, 0}}, {"B", 0, {1, 0, 0}}};
  data.mass = {{0, 0, 1.0}, {1, 1, 1.0}};
  data.force = data.initial_velocity = {0.0, 0.0};
  Scene scene{"test", Model(data), {}, {}};
  Output angle{"phi", Output::Kind::angle};
  angle.first = {0, 1};
  angle.second = {0, 2};
  scene.elements.outputs = {angle};
  OutputValues values(scene);
  for (int i = 0; i <= 40; ++i) {
    const double phi = 3.0 - 0.7 * i;
    const State state{{std::cos(phi), std::sin(phi)}, {0, 0}, {0, 0}, {}, 0.0};
    values.follow(0.1 * i, state);
    EXPECT_NEAR(values.values()[0], phi, 1e-13);
  }
}

TEST(OutputValues, AnglesInSpaceTurnAboutTheirAxis) {
  Scene scene = test::spatial_pendulum();
  const auto q = scene.model.initial_position();
  const State state{{q.begin(), q.end()},
                    std::vector<double>(9),
                    std::vector<double>(9),
                    std::vector<double>(5),
                    0.0};
  Output angle{"phi", Output::Kind::angle};
  angle.first = {0, 1};   // along x
  angle.second = {1, 2};  // along y
  angle.axis = 1;         // B is at (1, 0, 0): as an axis it is x, which sees no turn
  EXPECT_NEAR(values_of(scene, angle, 0, state, {"phi"})[0], 0.0, 1e-15);
  angle.first = {-1, 2};  // C as a vector: (1, 1, 0)
  angle.second = {2, 3};  // (0, 1, -0.5)
  EXPECT_NEAR(values_of(scene, angle, 0, state, {"phi"})[0], std::atan2(-0.5, 1.0), 1e-15);
}

TEST(OutputValues, AnglesInSpaceNeedNoDirectionAcrossTheAxis) {
  ModelData data;
  data.dimension = 3;
  data.points = {{"A", -1, {1, 0, 1}, true}, {"z", -1, {0, 0, 1}, true}, {"B", 0, {1, 0, 2}, true}};
  for (int i = 0; i < 3; ++i) data.mass.push_back({i, i, 1.0});
  data.force = data.initial_velocity = {0.0, 0.0, 0.0};
  Scene scene{"test", Model(data), {}, {}};
  Output angle{"phi", Output::Kind::angle};
  angle.first = {-1, 0};
  angle.second = {-1, 2};
  angle.axis = 1;
  for (const double phi : {0.3, 1.0, 2.5, -1.5}) {
    const State state{{std::cos(phi), std::sin(phi), 2}, {0, 0, 0}, {0, 0, 0}, {}, 0.0};
    EXPECT_NEAR(values_of(scene, angle, 0, state, {"phi"})[0], phi, 1e-14);
  }
}

TEST(OutputValues, ConstraintForcesArePulls) {
  // A rod of 2 m without mass holds 3 kg up: 3 * 9.81 N of tension, lambda = T / (2 L).
  ModelData data;
  data.points = {{"A", -1, {0, 0, 0}}, {"B", 0, {0, -2, 0}}};
  data.mass = {{0, 0, 3.0}, {1, 1, 3.0}};
  data.force = {0.0, -3 * 9.81};
  data.initial_velocity = {0.0, 0.0};
  data.dot_constraints = {{0, 1, 0, 1, 4.0, "string"}};
  data.linear_constraints = {{{{0, 1.0}}, 0.0, "rail"}};
  const Scene scene{"test", Model(data), {}, {}};
  const State state{{0, -2}, {0, 0}, {0, 0}, {3 * 9.81 / 4, -7.0}, 0.0};
  Output force{"tension", Output::Kind::constraint_force};
  force.first = {0, 1};
  force.rows = {0};
  EXPECT_NEAR(values_of(scene, force, 0, state, {"tension"})[0], 3 * 9.81, 1e-12);
  force.rows = {1};
  force.force = Output::Force::multiplier;
  force.factor = 0.5;
  EXPECT_EQ(values_of(scene, force, 0, state, {"tension"})[0], -3.5);
}

}  // namespace
}  // namespace mbs
