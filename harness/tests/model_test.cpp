// The checks of Model, and the harness's kinematics against finite differences and by hand.
#include "mbs/model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "model_math/jacobian_rank.hpp"
#include "model_math/kinematics.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Spatial, with every kind of constraint: A and D fixed, B and C free.
ModelData sample() {
  ModelData data;
  data.dimension = 3;
  data.points = {{"A", -1, {0.1, 0.2, 0.3}},
                 {"B", 3, {1.0, 0.5, -0.4}},
                 {"C", 0, {2.0, 1.5, 0.7}},
                 {"D", -1, {-1.0, 2.0, 0.5}}};
  data.dot_constraints = {{0, 1, 0, 1, 1.2, "distance"},
                          {1, 2, 0, 3, 0.3, "to the ground"},
                          {1, 0, 2, 1, 0.1, "sharing B"}};
  data.linear_constraints = {{{{5, 2.0}, {0, -1.5}}, 0.25, "linear"}};
  for (int i = 0; i < 6; ++i) data.mass.push_back({i, i, 2.0 + i});
  data.mass.push_back({3, 0, 0.5});
  data.mass.push_back({5, 1, 0.0});
  data.force = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  data.initial_velocity = {0.3, -0.1, 0.7, 0.2, 0.9, -0.6};
  return data;
}

using Damage = std::function<void(ModelData&)>;

TEST(Model, RefusesInconsistentData) {
  EXPECT_NO_THROW(Model{sample()});
  const Damage damages[] = {
      [](ModelData& d) { d.dimension = 4; },
      [](ModelData& d) { d.points[1].offset = 0; },
      [](ModelData& d) { d.points[1].offset = 4; },
      [](ModelData& d) { d.points[0].position[2] = kNaN; },
      [](ModelData& d) { d.dot_constraints[0].c = 4; },
      [](ModelData& d) { d.dot_constraints[0].a = -1; },
      [](ModelData& d) { d.dot_constraints[1].value = kNaN; },
      [](ModelData& d) { d.linear_constraints[0].terms[0].coordinate = 6; },
      [](ModelData& d) { d.linear_constraints[0].terms[0].coordinate = 0; },
      [](ModelData& d) { d.linear_constraints[0].terms[1].coefficient = kNaN; },
      [](ModelData& d) { d.linear_constraints[0].value = HUGE_VAL; },
      [](ModelData& d) { d.mass[0].value = 0.0; },
      [](ModelData& d) { d.mass[0].value = kNaN; },
      [](ModelData& d) { d.mass.erase(d.mass.begin()); },
      [](ModelData& d) {
        d.mass.push_back({3, 0, 0.1});
      },
      [](ModelData& d) {
        d.mass.push_back({0, 3, 0.1});
      },
      [](ModelData& d) {
        d.mass.push_back({6, 0, 0.1});
      },
      [](ModelData& d) { d.force.pop_back(); },
      [](ModelData& d) { d.force[3] = HUGE_VAL; },
      [](ModelData& d) { d.initial_velocity.push_back(0.0); },
      [](ModelData& d) { d.initial_velocity[0] = kNaN; },
  };
  int number = 0;
  for (const Damage& damage : damages) {
    ModelData data = sample();
    damage(data);
    EXPECT_THROW(Model{std::move(data)}, std::invalid_argument) << "damage " << number;
    ++number;
  }
}

TEST(Model, SortsMassAndGathersPositions) {
  const Model model(sample());
  EXPECT_EQ(model.variables(), 6);
  EXPECT_EQ(model.constraints(), 4);
  const auto mass = model.mass();
  ASSERT_EQ(mass.size(), 8u);
  EXPECT_EQ(mass[1].row, 3);  // (0, 0), then (3, 0)
  EXPECT_EQ(mass[1].col, 0);
  const std::vector<double> expected{2.0, 1.5, 0.7, 1.0, 0.5, -0.4};
  const auto position = model.initial_position();
  EXPECT_EQ(std::vector<double>(position.begin(), position.end()), expected);
}

TEST(Kinematics, ConstraintsAreThoseOfTheEquations) {
  const Model model(sample());
  const std::vector<double> q{2.0, 1.5, 0.7, 1.0, 0.5, -0.4};
  std::vector<double> phi(4);
  evaluate_constraints(model, 0.0, q, phi);
  EXPECT_NEAR(phi[0], 0.9 * 0.9 + 0.3 * 0.3 + 0.7 * 0.7 - 1.2, 1e-15);
  EXPECT_NEAR(phi[1], -1.0 * 1.1 + -1.0 * -1.8 + -1.1 * -0.2 - 0.3, 1e-15);
  EXPECT_NEAR(phi[2], 0.9 * 1.0 + 0.3 * 1.0 + -0.7 * 1.1 - 0.1, 1e-15);
  EXPECT_NEAR(phi[3], 2.0 * -0.4 - 1.5 * 2.0 - 0.25, 1e-15);
}

TEST(Kinematics, JacobianIsTheDerivative) {
  const Model model(sample());
  const std::vector<double> q{2.0, 1.5, 0.7, 1.0, 0.5, -0.4};
  const auto entries = jacobian(model, 0.0, q);
  EXPECT_EQ(entries.size(), 3u + 6u + 6u + 2u);
  std::vector<std::vector<double>> dense(4, std::vector<double>(6, 0.0));
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto& entry = entries[k];
    dense[static_cast<std::size_t>(entry.row)][static_cast<std::size_t>(entry.col)] += entry.value;
    if (k == 0) continue;
    EXPECT_TRUE(std::pair(entries[k - 1].row, entries[k - 1].col) <
                std::pair(entry.row, entry.col));
  }
  std::vector<double> rate(4);
  const std::vector<double> v(model.initial_velocity().begin(), model.initial_velocity().end());
  constraint_rate(model, 0.0, q, v, rate);
  std::vector<double> above(4);
  std::vector<double> below(4);
  for (std::size_t i = 0; i < 4; ++i) {
    double product = 0.0;
    for (std::size_t j = 0; j < 6; ++j) {
      product += dense[i][j] * v[j];
      auto q_above = q;
      auto q_below = q;
      q_above[j] += 0.125;  // central differences of a quadratic are exact
      q_below[j] -= 0.125;
      evaluate_constraints(model, 0.0, q_above, above);
      evaluate_constraints(model, 0.0, q_below, below);
      EXPECT_NEAR(dense[i][j], (above[i] - below[i]) / 0.25, 1e-14) << i << ", " << j;
    }
    EXPECT_NEAR(rate[i], product, 1e-14);
  }
}

TEST(Kinematics, EnergyOfASwingingRod) {
  // Thin rod about its end: kinetic energy m L^2 w^2 / 6; weight at the middle.
  const Model model(parse_scene(R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
      {"name": "B", "position": [0, 2], "velocity": [3, 0]}],
      "rods": [{"between": ["A", "B"], "mass": 6}]})",
                                "test")
                        .model);
  EXPECT_NEAR(energy(model, 0.0, model.initial_position(), model.initial_velocity()),
              6.0 * 4.0 * 1.5 * 1.5 / 6.0 + 6.0 * 9.81 * 1.0, 1e-12);
}

TEST(Kinematics, MassTimesUsesBothTriangles) {
  const Model model(sample());
  const std::vector<double> x{1.0, 0.0, 0.0, 10.0, 0.0, 0.0};
  std::vector<double> y(6);
  mass_times(model, x, y);
  EXPECT_EQ(y, (std::vector<double>{7.0, 0.0, 0.0, 50.5, 0.0, 0.0}));
}

TEST(Kinematics, NothingHidesANaN) {
  const Model model(sample());
  std::vector<double> q(model.initial_position().begin(), model.initial_position().end());
  const std::vector<double> v(6, 1.0);
  q[5] = kNaN;  // B.z
  std::vector<double> phi(4);
  evaluate_constraints(model, 0.0, q, phi);
  for (const double value : phi) EXPECT_TRUE(std::isnan(value));
  constraint_rate(model, 0.0, q, v, phi);
  EXPECT_TRUE(std::isnan(phi[0]));
  EXPECT_TRUE(std::isnan(energy(model, 0.0, q, v)));
  EXPECT_THROW(jacobian_rank(model, q), std::invalid_argument);
  std::vector<double> infinite(v);
  infinite[0] = HUGE_VAL;
  EXPECT_FALSE(std::isfinite(energy(model, 0.0, model.initial_position(), infinite)));
}

TEST(Kinematics, WrongSizesAreRefused) {
  const Model model(sample());
  const std::vector<double> q(6, 0.0);
  const std::vector<double> wrong(5, 0.0);
  std::vector<double> phi(4);
  EXPECT_THROW(evaluate_constraints(model, 0.0, wrong, phi), std::invalid_argument);
  EXPECT_THROW(constraint_rate(model, 0.0, q, wrong, phi), std::invalid_argument);
  EXPECT_THROW(jacobian(model, 0.0, wrong), std::invalid_argument);
  EXPECT_THROW(energy(model, 0.0, q, wrong), std::invalid_argument);
  phi.resize(5);
  EXPECT_THROW(evaluate_constraints(model, 0.0, q, phi), std::invalid_argument);
}

TEST(JacobianRank, CountsIndependentRows) {
  const JacobianEntry entries[] = {
      {0, 0, 1e-8}, {0, 1, 2e-8}, {1, 0, 3e8}, {1, 1, 6e8}, {2, 2, 1.0}};
  EXPECT_EQ(rank_of(3, 4, entries), 2);
  EXPECT_EQ(rank_of(2, 4, std::span(entries).first(2)), 1);
  EXPECT_EQ(rank_of(0, 4, {}), 0);
}

TEST(JacobianRank, FourBarLosesRankWhereItIsFlat) {
  const Model model(four_bar(3));
  EXPECT_EQ(jacobian_rank(model, model.initial_position()), 7);
  // All rods on the x axis: no constraint has a gradient along y.
  const std::vector<double> flat{1.0, 0.0, 2.0, 0.0, 3.0, 0.0, 4.0, 0.0};
  EXPECT_EQ(jacobian_rank(model, flat), 4);
  const Model large(four_bar(200));
  EXPECT_EQ(jacobian_rank(large, large.initial_position()), 401);
}

}  // namespace
}  // namespace mbs
