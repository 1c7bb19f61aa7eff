// Consistent accelerations and multipliers, and the smallest eigenvalue of Phi_q M^-1 Phi_q^T.
#include "run/initial_state.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "exact/four_bar_exact.hpp"
#include "model_math/kinematics.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"
#include "support/dense.hpp"
#include "support/sample_models.hpp"

namespace mbs {
namespace {

/// Both M a + Phi_q^T lambda = Q and Phi_q a = -(Phi_q)' v, to nine digits: the pivots of 1e-9 that
/// make redundant constraints solvable cost as many of long double's nineteen, and some are lost.
void expect_consistent(const Model& model, const State& state) {
  constexpr double kTolerance = 1e-7;
  const auto vector = [](std::span<const double> x) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  const Eigen::MatrixXd Phi_q = test::dense_jacobian(model, state.q);
  std::vector<double> curvature(static_cast<std::size_t>(model.constraints()));
  constraint_curvature(model, 0.0, state.q, state.v, curvature);
  const Eigen::VectorXd a = vector(state.a);
  const Eigen::VectorXd forces = test::dense_mass(model) * a +
                                 Phi_q.transpose() * vector(state.lambda) - vector(model.force());
  EXPECT_LT(forces.lpNorm<Eigen::Infinity>(), kTolerance);
  EXPECT_LT((Phi_q * a + vector(curvature)).lpNorm<Eigen::Infinity>(), kTolerance);
}

TEST(InitialState, IsExactOnTheFourBar) {
  for (const int loops : {1, 2, 10, 100}) {
    const Model model(four_bar(loops));
    const auto n = static_cast<std::size_t>(model.variables());
    std::vector<double> q(n), v(n), a(n);
    for (const double t : {0.0, 0.3, 0.6, 1.0, 2.0}) {
      FourBarExact(loops).state(t, q, v, a);
      const State state = consistent_state(model, q, v);
      EXPECT_EQ(state.q, q);
      EXPECT_EQ(state.v, v);
      for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(state.a[i], a[i], 1e-9) << loops << ", " << t;
      expect_consistent(model, state);
    }
  }
}

TEST(InitialState, StartsWhereTheModelStarts) {
  const Model model(test::spatial_pendulum().model);
  const State state = initial_state(model);
  EXPECT_TRUE(std::ranges::equal(state.q, model.initial_position()));
  EXPECT_TRUE(std::ranges::equal(state.v, model.initial_velocity()));
  EXPECT_EQ(state.lambda.size(), 5U);
  expect_consistent(model, state);
}

TEST(InitialState, RedundantConstraintsChangeNothingButTheirMultipliers) {
  ModelData data = four_bar(3);
  const State expected = initial_state(Model(data));
  data.dot_constraints.push_back(data.dot_constraints[1]);
  const Model model(std::move(data));
  const State state = initial_state(model);
  for (std::size_t i = 0; i < state.a.size(); ++i) EXPECT_NEAR(state.a[i], expected.a[i], 1e-10);
  // From zero, twins share what one of them would carry.
  EXPECT_NEAR(state.lambda[1], expected.lambda[1] / 2, 1e-8);
  EXPECT_NEAR(state.lambda[7], expected.lambda[1] / 2, 1e-8);
  for (const std::size_t k : {0U, 2U, 3U, 4U, 5U, 6U}) {
    EXPECT_NEAR(state.lambda[k], expected.lambda[k], 1e-8) << k;
  }
  expect_consistent(model, state);
}

/// Rows that depend on each other contradict themselves by what is rounded of them. More rounds
/// than it takes would move the multipliers along what has no force, further each time.
TEST(InitialState, MultipliersHaveNothingOfWhatHasNoForce) {
  const Model model = load_scene(MBS_ROOT "/harness/scenes/examples/driven_elbow.json").model;
  const State state = initial_state(model);
  const Eigen::MatrixXd S = test::dense_constraint_matrix(model, state.q);
  const int m = model.constraints();
  Eigen::VectorXd idle = Eigen::VectorXd::Ones(m);
  for (int round = 0; round < 3; ++round) {
    idle = (S + 1e-9 * Eigen::MatrixXd::Identity(m, m)).ldlt().solve(idle).normalized();
  }
  ASSERT_LT((S * idle).norm(), 1e-12);
  const Eigen::VectorXd lambda = Eigen::VectorXd::Map(state.lambda.data(), m);
  EXPECT_LT(std::abs(idle.dot(lambda)), 2e-7 * lambda.norm());
}

TEST(InitialState, WithoutConstraintsIsFreeFall) {
  const Model model(test::free_fall().model);
  const State state = initial_state(model);
  EXPECT_TRUE(state.lambda.empty());
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(state.a[i], i % 2 == 1 ? -9.81 : 0.0, 1e-15);
  EXPECT_TRUE(std::isinf(smallest_constraint_eigenvalue(model, model.initial_position())));
}

TEST(InitialState, ArtificialFillChangesNothing) {
  const Scene plain = load_scene("four-bar:5"), filled = load_scene("four-bar:5,fill=0.9");
  const State expected = initial_state(plain.model), state = initial_state(filled.model);
  for (std::size_t i = 0; i < state.a.size(); ++i) EXPECT_NEAR(state.a[i], expected.a[i], 1e-12);
}

TEST(SmallestConstraintEigenvalue, IsThatOfTheDenseMatrix) {
  std::vector<Model> models{test::spatial_pendulum().model};
  for (const int loops : {1, 2, 5, 20, 40}) models.emplace_back(four_bar(loops));
  for (const Model& model : models) {
    const auto q = model.initial_position();
    const double expected = test::eigenvalues(test::dense_constraint_matrix(model, q))[0];
    EXPECT_NEAR(smallest_constraint_eigenvalue(model, q), expected, 0.05 * expected)
        << model.variables();
  }
}

TEST(SmallestConstraintEigenvalue, LeavesOutWhatDependsOnOthers) {
  const Model flat(four_bar(3));
  const std::vector<double> q{1.0, 0.0, 2.0, 0.0, 3.0, 0.0, 4.0, 0.0};
  const Eigen::VectorXd values = test::eigenvalues(test::dense_constraint_matrix(flat, q));
  EXPECT_LT(values[2], 1e-12);  // three of seven
  EXPECT_NEAR(smallest_constraint_eigenvalue(flat, q), values[3], 0.05 * values[3]);
}

}  // namespace
}  // namespace mbs
