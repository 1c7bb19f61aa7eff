// Four bounds on alpha, two from below and two from above.
#include "describe/penalty_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model_math/turning.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"

namespace mbs {
namespace {

// With beta = alpha dt^2/4 and omega the rate of turning; fitted, see README.md here.
constexpr double kSlowestMode = 0.1;   // beta s_min omega dt >= this
constexpr double kSingular = 3.0;      // beta s_row omega dt >= this
constexpr double kNonlinear = 0.02;    // beta s_row (omega dt)^3 <= this
constexpr double kCancellation = 0.4;  // u l_r sqrt(beta s_mean) <= this times l (omega dt)^4

}  // namespace

PenaltyWindow penalty_window(const Model& model, const Structure& structure, double step) {
  PenaltyWindow window;
  // A mechanism at rest without forces says nothing: let it turn once in 1000 steps.
  const Turning fastest = fastest_turning(model);
  window.rate = fastest.rate > 0.0 ? fastest.rate : 2e-3 * std::numbers::pi / step;
  const double turn = window.rate * step;  // rad a step
  const double row = least_constraint_diagonal(model);
  double smallest = std::numeric_limits<double>::infinity();  // at a singular start it says nothing
  if (!structure.singular.value_or(true)) {
    smallest = smallest_constraint_eigenvalue(model, model.initial_position());
  }
  const double for_slowest = kSlowestMode / (smallest * turn);
  const double for_singular = kSingular / (row * turn);
  const double for_newton = kNonlinear / (row * std::pow(turn, 3));
  const double noise = std::numeric_limits<double>::epsilon() / 2 * rounding_length(model);
  const double for_rounding =
      std::pow(kCancellation * fastest.length * std::pow(turn, 4) / noise, 2) /
      mean_constraint_eigenvalue(model);
  // At the turn a step where both upper bounds meet: they go as its powers -3 and 8, the lower one
  // as -1.
  const double longer = std::pow(for_newton / for_rounding, 1.0 / 11);
  window.widest = for_newton / std::max(for_slowest, for_singular) / (longer * longer);
  window.slowest_mode = for_slowest > for_singular;
  window.cancellation = for_rounding < for_newton;
  const double per_beta = 4.0 / (step * step);
  window.lower = per_beta * std::max(for_slowest, for_singular);
  window.upper = per_beta * std::min(for_newton, for_rounding);
  window.automatic = automatic_penalty(model, {.step = step});
  return window;
}

}  // namespace mbs
