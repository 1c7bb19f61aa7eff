// One pass over the Jacobian.
#include "run/rounding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "model_math/kinematics.hpp"
#include "scene/row_names.hpp"

namespace mbs {

namespace {

bool has_penalty_forces(const StepSettings& settings) {
  return settings.scheme == Scheme::penalty && settings.precision != Precision::single_precision;
}

/// Largest |entry| of each row of the Jacobian.
std::vector<double> gradients(const Model& model, const std::vector<JacobianEntry>& entries) {
  std::vector<double> result(static_cast<std::size_t>(model.constraints()), 0.0);
  for (const JacobianEntry& entry : entries) {
    double& largest = result[static_cast<std::size_t>(entry.row)];
    largest = std::max(largest, std::abs(entry.value));
  }
  return result;
}

}  // namespace

std::string rounding_degradation(const Model& model, const StepSettings& settings, long steps,
                                 double length) {
  if (!has_penalty_forces(settings)) return "";
  constexpr double kAllowed = 0.1;
  const auto entries = jacobian(model, 0.0, model.initial_position());
  const std::vector<double> gradient = gradients(model, entries);
  std::vector<double> factor(gradient.size(), 1.0);  // largest entry of B
  std::size_t row = model.dot_constraints().size();
  for (const BilinearConstraint& c : model.bilinear_constraints()) {
    double& largest = factor[row++] = 0.0;
    for (const auto& line : c.B) {
      for (const double entry : line) largest = std::max(largest, std::abs(entry));
    }
  }
  const std::vector<double> mass = mass_diagonal(model);
  const double walk =
      settings.step * settings.step * std::pow(static_cast<double>(steps), 1.5) / std::sqrt(3.0);
  const double round = settings.penalty * std::numeric_limits<double>::epsilon();
  double most = 0.0;
  int worst = 0;
  for (const JacobianEntry& entry : entries) {
    // Of a distance of length L times a factor d the gradient is 2 d L and what Phi is small
    // against d L^2.
    const auto k = static_cast<std::size_t>(entry.row);
    const double size = std::pow(gradient[k] / 2, 2) / factor[k];
    const double acceleration =
        round * size * std::abs(entry.value) / mass[static_cast<std::size_t>(entry.col)];
    if (acceleration > most) {
      most = acceleration;
      worst = entry.col;
    }
  }
  if (most * walk <= kAllowed * length) return "";
  return fmt::format(
      "rounding of the penalty forces may drive {}, which is light, by {:.1e} m: try --scheme "
      "saddle-point",
      variable_name(model, worst), most * walk);
}

double rounding_of_penalty_forces(const Model& model, double penalty, const State& state) {
  const auto gradient = gradients(model, jacobian(model, state.t, state.q));
  std::vector<double> applied(state.q.size());
  applied_force(model, state.t, state.q, state.v, applied);
  double coordinate = 0.0, rounding = 0.0, force = 0.0;
  for (const double q : state.q) coordinate = std::max(coordinate, std::abs(q));
  for (const double load : applied) force = std::max(force, std::abs(load));
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    rounding = std::max(rounding, penalty * gradient[k] * gradient[k] * coordinate *
                                      std::numeric_limits<double>::epsilon());
    force = std::max(force, gradient[k] * std::abs(state.lambda[k]));
  }
  return force == 0.0 ? 0.0 : rounding / force;
}

std::string drowned_forces(const Model& model, const StepSettings& settings, const State& state) {
  if (!has_penalty_forces(settings)) return "";
  constexpr double kAllowed = 0.1;
  const double share = rounding_of_penalty_forces(model, settings.penalty, state);
  if (share <= kAllowed) return "";
  return fmt::format("rounding may be {:.0f} % of the constraint forces: --scheme saddle-point",
                     100 * share);
}

}  // namespace mbs
