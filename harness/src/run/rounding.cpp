// One pass over the Jacobian.
#include "run/rounding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "model_math/kinematics.hpp"

namespace mbs {

namespace {

/// Largest |entry| of each row of the Jacobian at `state`.
std::vector<double> gradients(const Model& model, const State& state) {
  std::vector<double> result(static_cast<std::size_t>(model.constraints()), 0.0);
  for (const JacobianEntry& entry : jacobian(model, state.t, state.q)) {
    double& largest = result[static_cast<std::size_t>(entry.row)];
    largest = std::max(largest, std::abs(entry.value));
  }
  return result;
}

}  // namespace

double rounding_of_penalty_forces(const Model& model, const Model& solved, double penalty,
                                  const State& state, double epsilon) {
  const std::vector<double> gradient = gradients(model, state), scaled = gradients(solved, state);
  std::vector<double> applied(state.q.size());
  applied_force(model, state.t, state.q, state.v, applied);
  double coordinate = 0.0, rounding = 0.0, force = 0.0;
  for (const double q : state.q) coordinate = std::max(coordinate, std::abs(q));
  for (const double load : applied) force = std::max(force, std::abs(load));
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    rounding = std::max(rounding, penalty * scaled[k] * scaled[k] * coordinate * epsilon);
    force = std::max(force, gradient[k] * std::abs(state.lambda[k]));
  }
  return force == 0.0 ? 0.0 : rounding / force;
}

std::string drowned_forces(const Model& model, const Model& solved, const StepSettings& settings,
                           const State& state) {
  if (settings.scheme != Scheme::penalty) return "";
  constexpr double kAllowed = 0.1;
  const bool is_single = settings.precision == Precision::single_precision;  // also of the state
  const double share =
      rounding_of_penalty_forces(model, solved, settings.penalty, state,
                                 is_single ? double{std::numeric_limits<float>::epsilon()}
                                           : std::numeric_limits<double>::epsilon());
  if (share <= kAllowed) return "";
  return fmt::format("rounding may be {:.0f} % of the constraint forces: --scheme saddle-point",
                     100 * share);
}

}  // namespace mbs
