// The harness's own mechanics against difference quotients of itself, on every kind of term.
#include "model_math/kinematics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "model_math/connected_parts.hpp"
#include "scene/tangent_pattern.hpp"
#include "support/gtest_name.hpp"
#include "support/term_models.hpp"

namespace mbs {
namespace {

using Values = std::vector<double>;

constexpr double kTime = 0.37;  // s
constexpr double kDifference = 1e-6;

/// A motion that has nothing to do with the model: q(t), v(t), a(t) of each coordinate.
struct Motion {
  Values q, v, a;
};
Motion motion(const Model& model, double t) {
  Motion result;
  for (int i = 0; i < model.variables(); ++i) {
    const double phase = 0.9 * i, rate = 1.0 + 0.3 * i;
    result.q.push_back(model.initial_position()[i] + 0.1 * std::sin(rate * t + phase));
    result.v.push_back(0.1 * rate * std::cos(rate * t + phase));
    result.a.push_back(-0.1 * rate * rate * std::sin(rate * t + phase));
  }
  return result;
}

Values phi_at(const Model& model, double t, const Values& q) {
  Values phi(model.constraints());
  evaluate_constraints(model, t, q, phi);
  return phi;
}
Values rate_at(const Model& model, double t) {
  const Motion at = motion(model, t);
  Values rate(model.constraints());
  constraint_rate(model, t, at.q, at.v, rate);
  return rate;
}
Values jacobian_times(const Model& model, double t, const Values& q, const Values& x) {
  Values product(model.constraints(), 0.0);
  for (const JacobianEntry& entry : jacobian(model, t, q)) {
    product[entry.row] += entry.value * x[entry.col];
  }
  return product;
}

class Kinematics : public ::testing::TestWithParam<TermModel> {};

TEST_P(Kinematics, RateIsTheDerivativeOfPhiAlongAMotion) {
  const Model& model = GetParam().model;
  const Values after = phi_at(model, kTime + kDifference, motion(model, kTime + kDifference).q);
  const Values before = phi_at(model, kTime - kDifference, motion(model, kTime - kDifference).q);
  const Values rate = rate_at(model, kTime);
  for (int k = 0; k < model.constraints(); ++k) {
    EXPECT_NEAR(rate[k], (after[k] - before[k]) / (2 * kDifference), 1e-8) << "row " << k;
  }
}

TEST_P(Kinematics, JacobianIsTheDerivativeOfPhi) {
  const Model& model = GetParam().model;
  const Motion at = motion(model, kTime);
  for (int i = 0; i < model.variables(); ++i) {
    Values unit(model.variables(), 0.0), above = at.q, below = at.q;
    unit[i] = 1.0;
    above[i] += kDifference;
    below[i] -= kDifference;
    const Values column = jacobian_times(model, kTime, at.q, unit);
    const Values high = phi_at(model, kTime, above), low = phi_at(model, kTime, below);
    for (int k = 0; k < model.constraints(); ++k) {
      EXPECT_NEAR(column[k], (high[k] - low[k]) / (2 * kDifference), 1e-8) << k << ", " << i;
    }
  }
}

TEST_P(Kinematics, CurvatureIsWhatTheRateGainsBesidesAcceleration) {
  const Model& model = GetParam().model;
  const Motion at = motion(model, kTime);
  const Values after = rate_at(model, kTime + kDifference),
               before = rate_at(model, kTime - kDifference);
  const Values accelerated = jacobian_times(model, kTime, at.q, at.a);
  Values curvature(model.constraints());
  constraint_curvature(model, kTime, at.q, at.v, curvature);
  for (int k = 0; k < model.constraints(); ++k) {
    EXPECT_NEAR(accelerated[k] + curvature[k], (after[k] - before[k]) / (2 * kDifference), 1e-6);
  }
}

/// At rest, without couples and drivers, the force is minus the gradient of the energy.
TEST_P(Kinematics, ForceIsTheGradientOfThePotential) {
  const Model& model = GetParam().model;
  const auto changes = [](const auto& law) { return !law.law.factor.is_constant(); };
  if (!model.couples().empty() || !model.driven_mass().empty() || !model.driven_points().empty() ||
      std::ranges::any_of(model.force_laws(), changes)) {
    GTEST_SKIP() << "has forces without a potential";
  }
  Values is_length(model.variables(), 0.0);  // of a unit vector: constrained, so without a force
  for (const Point& point : model.points()) {
    if (point.is_vector && !point.is_fixed()) is_length[point.offset + 2] = 1.0;
  }
  const Values q(model.initial_position().begin(), model.initial_position().end());
  const Values rest(model.variables(), 0.0);
  Values force(model.variables());
  applied_force(model, kTime, q, rest, force);
  for (int i = 0; i < model.variables(); ++i) {
    Values above = q, below = q;
    above[i] += kDifference;
    below[i] -= kDifference;
    const double slope =
        (potential_energy(model, kTime, above) - potential_energy(model, kTime, below)) /
        (2 * kDifference);
    if (is_length[i] != 0.0) continue;
    EXPECT_NEAR(force[i], -slope, 1e-6) << "coordinate " << i;
  }
}

/// Dampers take energy: the power of what the velocity adds to the force is not positive.
TEST_P(Kinematics, DampersTakeEnergy) {
  const Model& model = GetParam().model;
  if (!model.driven_points().empty()) GTEST_SKIP() << "its driver may give energy";
  const Motion at = motion(model, kTime);
  Values moving(model.variables()), still(model.variables()), rest(model.variables(), 0.0);
  applied_force(model, kTime, at.q, at.v, moving);
  applied_force(model, kTime, at.q, rest, still);
  double power = 0.0, damping = 0.0;
  for (int i = 0; i < model.variables(); ++i) power += (moving[i] - still[i]) * at.v[i];
  for (const Spring& spring : model.springs()) damping += spring.damping;
  for (const TorsionSpring& spring : model.torsion_springs()) damping += spring.damping;
  for (const ForceLaw& law : model.force_laws()) damping += law.law.by_rate.is_zero() ? 0.0 : 1.0;
  if (damping > 0.0) {
    EXPECT_LT(power, 0.0);
  } else {
    EXPECT_EQ(power, 0.0);
  }
}

/// What is joined by its force alone is in the pattern of the tangent and of one part.
TEST_P(Kinematics, PatternAndPartsKnowWhatTheForceJoins) {
  if (!GetParam().model.couples().empty()) GTEST_SKIP() << "couples stay out of the tangent";
  ModelData data = GetParam().model.data();
  data.dot_constraints.clear();
  data.bilinear_constraints.clear();
  data.linear_constraints.clear();
  data.driven_values.clear();
  std::erase_if(data.mass, [](const MassEntry& entry) { return entry.row != entry.col; });
  const Model model(std::move(data));
  const Motion at = motion(model, kTime);
  const auto moves = [&](int moved, int felt) {  // by position or velocity
    Values above(model.variables()), below(model.variables());
    double most = 0.0;
    for (const bool is_rate : {false, true}) {
      Motion there = at;
      Values& x = is_rate ? there.v : there.q;
      x[moved] += kDifference;
      applied_force(model, kTime, there.q, there.v, above);
      x[moved] -= 2 * kDifference;
      applied_force(model, kTime, there.q, there.v, below);
      most = std::max(most, std::abs(above[felt] - below[felt]) / (2 * kDifference));
    }
    return most > 1e-4;
  };
  TangentPattern pattern(model, PatternOf::leading_block);
  ConnectedParts parts(model);
  for (int col = 0; col < model.variables(); ++col) {
    for (int row = col + 1; row < model.variables(); ++row) {
      if (!moves(col, row) || !moves(row, col)) continue;  // an axis moves what does not move it
      EXPECT_NE(std::ranges::count(pattern.below(col), row), 0) << row << ", " << col;
      EXPECT_EQ(parts.part_of(row), parts.part_of(col)) << row << ", " << col;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Terms, Kinematics, ::testing::ValuesIn(term_models()),
                         [](const auto& info) { return test::gtest_name(info.param.name); });

}  // namespace
}  // namespace mbs
