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
// In single precision:
constexpr double kOnePass = 2e-7;      // beta s_min (omega dt)^4 >= this
constexpr double kRoundedMass = 1e-2;  // u beta s_mean <= this

}  // namespace

PenaltyWindow penalty_window(const Model& model, const Structure& structure,
                             const StepSettings& settings) {
  PenaltyWindow window;
  const double step = settings.step;
  const bool single = settings.precision == Precision::single_precision;
  // A mechanism at rest without forces says nothing: let it turn once in 1000 steps.
  const Turning fastest = fastest_turning(model);
  window.rate = fastest.rate > 0.0 ? fastest.rate : 2e-3 * std::numbers::pi / step;
  const double turn = window.rate * step;  // rad a step
  const double row = least_constraint_diagonal(model);
  double smallest = std::numeric_limits<double>::infinity();  // at a singular start it says nothing
  if (!structure.singular.value_or(true)) {
    smallest = smallest_constraint_eigenvalue(model, model.initial_position());
  }
  const double for_slowest =
      single ? kOnePass / (smallest * std::pow(turn, 4)) : kSlowestMode / (smallest * turn);
  const double for_singular = kSingular / (row * turn);
  const double for_newton = kNonlinear / (row * std::pow(turn, 3));
  const double mean = mean_constraint_eigenvalue(model);
  const double noise = std::numeric_limits<double>::epsilon() / 2 * rounding_length(model);
  const double for_rounding =
      single ? kRoundedMass / (std::numeric_limits<float>::epsilon() / 2 * mean)
             : std::pow(kCancellation * fastest.length * std::pow(turn, 4) / noise, 2) / mean;
  // At the turn a step where both upper bounds meet: they go as its powers -3 and 8 (in single
  // precision 0), the lower one as -1 (the slowest mode in single precision as -4).
  double longer = std::pow(for_newton / for_rounding, single ? 1.0 / 3 : 1.0 / 11);
  if (single) longer = std::max(longer, std::cbrt(for_slowest / for_singular));
  window.widest = for_newton * std::pow(longer, -3) /
                  std::max(for_slowest * std::pow(longer, single ? -4 : -1), for_singular / longer);
  window.slowest_mode = for_slowest > for_singular;
  window.cancellation = for_rounding < for_newton;
  const double per_beta = 4.0 / (step * step);
  window.lower = per_beta * std::max(for_slowest, for_singular);
  window.upper = per_beta * std::min(for_newton, for_rounding);
  window.automatic = automatic_penalty(model, {.step = step, .precision = settings.precision});
  return window;
}

}  // namespace mbs
