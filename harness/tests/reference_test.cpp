// The reference itself: its factorization, its order, its constraints and its energy.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "exact/four_bar_exact.hpp"
#include "model_math/kinematics.hpp"
#include "reference/reference_simulation.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/dense.hpp"
#include "support/sample_models.hpp"

namespace mbs {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// A random symmetric matrix with the envelope `first`; diagonally dominant by `dominance`.
Matrix random_matrix(const std::vector<int>& first, double dominance, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto n = static_cast<Eigen::Index>(first.size());
  Matrix A = Matrix::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = first[static_cast<std::size_t>(i)]; j < i; ++j) {
      A(i, j) = A(j, i) = uniform(random);
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) A(i, i) = A.row(i).cwiseAbs().sum() + dominance;
  return A;
}

std::vector<int> random_envelope(int n, int width, std::mt19937& random) {
  std::vector<int> first;
  for (int i = 0; i < n; ++i) {
    const int lowest = std::max(0, i - width);
    first.push_back(std::uniform_int_distribution<int>(lowest, i)(random));
  }
  return first;
}

EnvelopeLdlt stored(const Matrix& A, const std::vector<int>& first) {
  EnvelopeLdlt result(first);
  result.set_zero();
  for (int i = 0; i < static_cast<int>(first.size()); ++i) {
    for (int j = first[static_cast<std::size_t>(i)]; j <= i; ++j) result.at(i, j) = A(i, j);
  }
  return result;
}

TEST(EnvelopeLdlt, SolvesLikeEigen) {
  std::mt19937 random(1);
  for (const int n : {1, 2, 7, 40}) {
    for (const int width : {0, 1, 3, n}) {
      const std::vector<int> first = random_envelope(n, width, random);
      const Matrix A = random_matrix(first, 0.5, random);
      EnvelopeLdlt factor = stored(A, first);
      ASSERT_TRUE(factor.factorize(0));
      std::vector<Real> b(static_cast<std::size_t>(n));
      for (Real& value : b) value = std::uniform_real_distribution<double>(-1, 1)(random);
      const Vector right = Eigen::Map<const Vector>(b.data(), n);
      const Vector expected = A.llt().solve(right);
      factor.solve(b);
      const Vector x = Eigen::Map<const Vector>(b.data(), n);
      EXPECT_LT(static_cast<double>((x - expected).norm()), 1e-17 * n) << n << ", " << width;
      EXPECT_LT(static_cast<double>((A * x - right).norm()), 1e-17 * n);
    }
  }
}

TEST(EnvelopeLdlt, CanBeFilledAndFactorizedAgain) {
  std::mt19937 random(2);
  const std::vector<int> first = random_envelope(20, 6, random);
  const Matrix A = random_matrix(first, 0.5, random);
  EnvelopeLdlt factor = stored(random_matrix(first, 2.0, random), first);
  ASSERT_TRUE(factor.factorize(0));
  factor.set_zero();
  for (int i = 0; i < 20; ++i) {
    for (int j = first[static_cast<std::size_t>(i)]; j <= i; ++j) factor.at(i, j) += A(i, j);
  }
  ASSERT_TRUE(factor.factorize(0));
  std::vector<Real> b(20, 1.0L);
  factor.solve(b);
  EXPECT_LT(
      static_cast<double>((A * Eigen::Map<const Vector>(b.data(), 20) - Vector::Ones(20)).norm()),
      1e-17);
}

TEST(EnvelopeLdlt, RefusesWhatIsNotPositiveDefinite) {
  std::mt19937 random(3);
  const std::vector<int> first = random_envelope(30, 8, random);
  const Matrix A = random_matrix(first, 0.5, random);
  const Real smallest = test::eigenvalues(A.cast<double>())[0];
  for (const double factor : {0.99, 1.01, 3.0}) {
    const Matrix shifted = A - factor * smallest * Matrix::Identity(30, 30);
    EXPECT_EQ(stored(shifted, first).factorize(0), factor < 1.0) << factor;
  }
  Matrix spoiled = A;
  spoiled(17, 17) = std::numeric_limits<Real>::quiet_NaN();
  EXPECT_FALSE(stored(spoiled, first).factorize(0));
  EXPECT_FALSE(stored(Matrix::Zero(30, 30), first).factorize(0));
}

/// Settings that keep alpha dt^2 fixed and what Newton leaves below the integrator's own error.
StepSettings refined(const Model& model, double step) {
  constexpr double kBase = 1e-3;
  return {step, automatic_penalty(model, {.step = kBase}) * std::pow(kBase / step, 2),
          1e-10 * std::pow(step / kBase, 4), 50};
}

State state_after(const Scene& scene, const StepSettings& settings, double duration) {
  ReferenceSimulation simulation(scene.model, settings);
  simulation.set_state(initial_state(scene.model));
  const long steps = std::lround(duration / settings.step);
  for (long i = 0; i < steps; ++i) EXPECT_EQ(simulation.step().status, StepStatus::converged);
  State state;
  simulation.get_state(state);
  return state;
}

double largest_difference(const std::vector<double>& x, const std::vector<double>& y) {
  return (Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())) -
          Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size())))
      .cwiseAbs()
      .maxCoeff();
}

// With alpha dt^2 fixed, positions and velocities are of second order, lambda of first; in a the
// projection leaves a first-order part, which is the smaller one at these steps.
TEST(ReferenceSimulation, IsOfSecondOrderOnTheFourBar) {
  for (const int loops : {1, 2, 5}) {
    const Scene scene = load_scene("four-bar:" + std::to_string(loops));
    const auto n = static_cast<std::size_t>(scene.model.variables());
    std::vector<double> q(n), v(n), a(n);
    FourBarExact(loops).state(0.6, q, v, a);
    const State exact = consistent_state(scene.model, q, v);
    const State coarse = state_after(scene, refined(scene.model, 2e-3), 0.6);
    const State fine = state_after(scene, refined(scene.model, 1e-3), 0.6);
    const auto order = [&](auto quantity) {
      return std::log2(largest_difference(coarse.*quantity, exact.*quantity) /
                       largest_difference(fine.*quantity, exact.*quantity));
    };
    EXPECT_NEAR(order(&State::q), 2.0, 0.05) << loops;
    EXPECT_NEAR(order(&State::v), 2.0, 0.05) << loops;
    EXPECT_NEAR(order(&State::lambda), 1.0, 0.05) << loops;
    EXPECT_GT(order(&State::a), 1.5) << loops;
    EXPECT_LT(largest_difference(fine.a, exact.a), 1e-4) << loops;
  }
}

/// The motion with Phi'' = 0 instead of the penalties, by the classical Runge-Kutta method.
State motion_on_constraints(const Model& model, double duration, long steps) {
  const auto n = static_cast<std::size_t>(model.variables());
  const double h = duration / static_cast<double>(steps);
  State x = initial_state(model);
  const auto moved = [&](double factor, const State& rate) {
    std::vector<double> q(n), v(n);
    for (std::size_t i = 0; i < n; ++i) {
      q[i] = x.q[i] + factor * rate.v[i];
      v[i] = x.v[i] + factor * rate.a[i];
    }
    return consistent_state(model, q, v);
  };
  for (long step = 0; step < steps; ++step) {
    const State k1 = x, k2 = moved(h / 2, k1), k3 = moved(h / 2, k2), k4 = moved(h, k3);
    State sum = k1;
    for (std::size_t i = 0; i < n; ++i) {
      sum.v[i] = (k1.v[i] + 2 * k2.v[i] + 2 * k3.v[i] + k4.v[i]) / 6;
      sum.a[i] = (k1.a[i] + 2 * k2.a[i] + 2 * k3.a[i] + k4.a[i]) / 6;
    }
    x = moved(h, sum);
  }
  return x;
}

TEST(ReferenceSimulation, FollowsASpatialMotion) {
  const Scene scene = test::spatial_pendulum();
  const State expected = motion_on_constraints(scene.model, 0.5, 1000);
  const State coarse = state_after(scene, refined(scene.model, 1e-3), 0.5);
  const State fine = state_after(scene, refined(scene.model, 5e-4), 0.5);
  for (const auto quantity : {&State::q, &State::v}) {
    const double coarse_error = largest_difference(coarse.*quantity, expected.*quantity);
    const double fine_error = largest_difference(fine.*quantity, expected.*quantity);
    EXPECT_NEAR(std::log2(coarse_error / fine_error), 2.0, 0.1);
  }
  EXPECT_LT(largest_difference(fine.q, expected.q), 1e-5);
  EXPECT_LT(largest_difference(fine.a, expected.a), 1e-4);
  EXPECT_LT(largest_difference(fine.lambda, expected.lambda), 5e-2);  // of first order
}

TEST(ReferenceSimulation, KeepsConstraintsAndEnergyOfASpatialMotion) {
  const Scene scene = test::spatial_pendulum();
  const Model& model = scene.model;
  double previous_drift = 0.0;
  for (const double step : {2e-3, 1e-3}) {
    ReferenceSimulation simulation(model, refined(model, step));
    State state = initial_state(model);
    simulation.set_state(state);
    const double energy_before = energy(model, 0.0, state.q, state.v);
    double drift = 0.0, violation = 0.0;
    std::vector<double> phi(static_cast<std::size_t>(model.constraints()));
    for (long i = 0; i < std::lround(2.0 / step); ++i) {
      ASSERT_NE(simulation.step().status, StepStatus::factorization_failed);
      simulation.get_state(state);
      drift = std::max(drift, std::abs(energy(model, 0.0, state.q, state.v) - energy_before));
      evaluate_constraints(model, 0.0, state.q, phi);
      for (const double value : phi) violation = std::max(violation, std::abs(value));
    }
    EXPECT_LT(drift, 0.02) << step;  // of 30 J that change hands
    EXPECT_LT(violation, 1e-9) << step;
    if (previous_drift > 0.0) {
      EXPECT_NEAR(std::log2(previous_drift / drift), 2.0, 0.2);
    }
    previous_drift = drift;
  }
}

/// Its multipliers do not wait for the body, which all of its legs share.
TEST(ReferenceSimulation, LegsOnOneBodyMoveAlikeInBothForms) {
  const Scene scene = load_scene("star:60");
  StepSettings settings = refined(scene.model, 1e-3);
  settings.tolerance = 1e-15;
  const State one = state_after(scene, settings, 0.02);
  settings.scheme = Scheme::saddle_point;
  const State other = state_after(scene, settings, 0.02);
  EXPECT_LT(largest_difference(one.q, other.q), 1e-12);
  EXPECT_LT(largest_difference(one.v, other.v), 1e-9);
  EXPECT_GT(largest_difference(one.q, initial_state(scene.model).q), 1e-4);
}

TEST(ReferenceSimulation, FreeFallIsExact) {
  const Scene scene = test::free_fall();
  const State start = initial_state(scene.model);
  const StepSettings settings{.step = 0.25, .penalty = 1.0, .tolerance = 1e-9};
  ReferenceSimulation simulation(scene.model, settings);
  simulation.set_state(start);
  State state;
  for (int i = 1; i <= 40; ++i) {
    const StepOutcome outcome = simulation.step();
    EXPECT_EQ(outcome.status, StepStatus::converged);
    EXPECT_EQ(outcome.passes, 1);
    simulation.get_state(state);
    const double t = 0.25 * i;
    for (std::size_t k = 0; k < 4; ++k) {
      const double g = k % 2 == 1 ? -9.81 : 0.0;
      EXPECT_NEAR(state.q[k], start.q[k] + start.v[k] * t + g * t * t / 2, 1e-12);
      EXPECT_NEAR(state.v[k], start.v[k] + g * t, 1e-13);
      EXPECT_NEAR(state.a[k], g, 1e-14);
    }
  }
}

TEST(ReferenceSimulation, StopsAtThePassLimit) {
  const Scene scene = load_scene("four-bar:2");
  const StepSettings settings{.penalty = 1e8, .tolerance = 1e-30, .max_passes = 3};
  ReferenceSimulation simulation(scene.model, settings);
  simulation.set_state(initial_state(scene.model));
  const StepOutcome outcome = simulation.step();
  EXPECT_EQ(outcome.status, StepStatus::pass_limit);
  EXPECT_EQ(outcome.passes, 3);
}

TEST(ReferenceSimulation, TangentConditionIsThatOfTheTangent) {
  std::vector<Scene> scenes{test::spatial_pendulum(), test::free_fall()};
  for (const char* name : {"four-bar:1", "four-bar:5", "four-bar:20", "four-bar:10,fill=0.6"}) {
    scenes.push_back(load_scene(name));
  }
  for (const Scene& scene : scenes) {
    for (const double penalty : {1.0, 1e8, 1e10}) {
      const StepSettings settings{.penalty = penalty, .tolerance = 1e-9};
      ReferenceSimulation simulation(scene.model, settings);
      State state = initial_state(scene.model);
      simulation.set_state(state);
      const Eigen::VectorXd eigenvalues = test::eigenvalues(test::dense_tangent(scene.model, state.q, settings));
      const double expected = eigenvalues.maxCoeff() / eigenvalues.minCoeff();
      EXPECT_NEAR(simulation.tangent_condition(), expected, 0.05 * expected)
          << scene.name << ", penalty " << penalty;
    }
  }
}

/// By dense matrices: (eps + J M^-1 J^T)^-1, and the tangent with the penalty factor that it makes.
TEST(ReferenceSimulation, InTheSaddlePointFormNoConditionGrowsWithAlpha) {
  const Scene scene = load_scene("four-bar:3");
  for (const double penalty : {1e8, 1e12, 1e25}) {
    const StepSettings settings{
        .penalty = penalty, .tolerance = 1e-9, .scheme = Scheme::saddle_point};
    ReferenceSimulation simulation(scene.model, settings);
    simulation.set_state(initial_state(scene.model));
    static_cast<void>(simulation.step());
    State state;
    simulation.get_state(state);
    StepSettings in_effect = settings;
    in_effect.penalty = 4 / (settings.step * settings.step) /
                        (4 / (settings.step * settings.step * penalty) +
                         smallest_constraint_eigenvalue(scene.model, state.q));
    EXPECT_NEAR(simulation.effective_penalty(), in_effect.penalty, 0.05 * in_effect.penalty)
        << penalty;
    const Eigen::VectorXd eigenvalues =
        test::eigenvalues(test::dense_tangent(scene.model, state.q, in_effect));
    const double expected = eigenvalues.maxCoeff() / eigenvalues.minCoeff();
    EXPECT_NEAR(simulation.tangent_condition(), expected, 0.1 * expected) << penalty;
  }
}

}  // namespace
}  // namespace mbs
