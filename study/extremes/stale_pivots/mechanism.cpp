// The N-four-bar mechanism with what may change violently: masses, contacts, multipliers.
#include "mechanism.hpp"

#include <cmath>
#include <span>
#include <utility>

#include "csc_klu/equations.hpp"
#include "csc_klu/geometric_stiffness.hpp"
#include "csc_klu/saddle_matrix.hpp"
#include "csc_klu/tangent.hpp"

namespace mbs::stale_pivots {
namespace {

constexpr int kVariables = 2 * kLoops + 2;
constexpr double kStep = 1.25e-3;  ///< dt, s

/// Contacts are springs to points at the left, shorter than without force: no p in Eq. (11).
Model model_of(const Instant& instant) {
  ModelData data;
  for (int i = 0; i <= kLoops; ++i) {
    const int A = 3 * i, B = A + 1, contact = A + 2;
    data.points.push_back({"A", -1, {double(i), 0.0}});
    data.points.push_back({"B", 2 * i, {double(i), 1.0}});
    data.points.push_back({"contact", -1, {i - 3.0, 0.5}});
    data.dot_constraints.push_back({A, B, A, B, 1.0, "rod"});
    if (i > 0) data.dot_constraints.push_back({B - 3, B, B - 3, B, 1.0, "coupler"});
    data.springs.push_back({B, contact, instant.contact[i], 0.0, 10.0, "contact"});
    const int couplers = (i > 0) + (i < kLoops);
    for (int k = 2 * i; k < 2 * i + 2; ++k) {
      const double mass = instant.rod_mass[i] + couplers * instant.coupler_mass;
      data.mass.push_back({k, k, mass / 3.0});
      if (i > 0) data.mass.push_back({k, k - 2, instant.coupler_mass / 6.0});
    }
  }
  data.force.assign(kVariables, 0.0);
  data.initial_velocity.assign(kVariables, 0.0);
  return Model(std::move(data));
}

/// Everything that a step evaluates.
struct Evaluation {
  explicit Evaluation(const Instant& instant) : model(model_of(instant)), equations(model, kStep) {
    if (!instant.lambda.empty()) hessians = hessian_entries(model, equations.jacobian_pattern);
    for (int i = 0; i <= kLoops; ++i) {
      equations.q[2 * i] = i + std::sin(instant.angle);
      equations.q[2 * i + 1] = std::cos(instant.angle);
    }
    equations.evaluate_constraints();
    std::vector<double> unused(equations.n);
    equations.forces.evaluate(equations.q.data(), equations.v.data(), unused.data());
  }

  /// The share of Eq. (16); without the error of Phi, which is rounding.
  [[nodiscard]] GeometricStiffness geometric(const Instant& instant, const Pattern& pattern) const {
    GeometricStiffness stiffness(hessians, pattern, equations.weight);
    if (stiffness.any()) stiffness.evaluate(0.0, instant.lambda, equations.phi);
    return stiffness;
  }

  const Model model;
  Equations<2> equations;
  std::vector<HessianEntry> hessians;
};

std::vector<double> copy(std::span<const double> values) { return {values.begin(), values.end()}; }

}  // namespace

Matrix tangent_matrix(const Instant& instant) {
  const Evaluation at(instant);
  const Equations<2>& e = at.equations;
  const TangentPattern<2> pattern(at.model, e.jacobian_pattern, e.force_pattern);
  Tangent<2> tangent(pattern, mass_values(at.model, pattern.pattern), e.weight * instant.penalty);
  tangent.assemble(e.jacobian);
  tangent.add(e.forces);
  tangent.add(at.geometric(instant, pattern.pattern));
  return {pattern.pattern, pattern.order, copy(tangent.values())};
}

std::vector<double> scales_at(const Instant& instant) {
  const Evaluation at(instant);
  return multiplier_scales(at.model, at.equations.jacobian_pattern, at.equations.jacobian);
}

Matrix saddle_matrix(const Instant& instant, const std::vector<double>& scales) {
  const Evaluation at(instant);
  const Equations<2>& e = at.equations;
  const SaddlePattern<2> pattern(at.model, e.jacobian_pattern, element_blocks(e.force_pattern, 2),
                                 at.hessians);
  SaddleMatrix<2> matrix(pattern, at.model, 1.0 / (e.weight * instant.penalty), scales);
  const GeometricStiffness geometric = at.geometric(instant, pattern.pattern);
  matrix.assemble(e.jacobian);
  matrix.reset(geometric);
  matrix.assemble(e.forces);
  matrix.add(geometric);
  return {pattern.pattern, pattern.order, copy(matrix.values())};
}

}  // namespace mbs::stale_pivots
