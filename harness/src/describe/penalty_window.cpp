// Bounds on alpha from below and from above.
#include "describe/penalty_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model_math/turning.hpp"
#include "run/settings.hpp"

namespace mbs {
namespace {

// With beta = alpha dt^2/4 and omega the rate of turning; fitted, see penalty_window.md here.
constexpr double kSlowestMode = 0.1;  // beta s_min omega dt >= this
constexpr double kSingular = 3.0;     // beta s_row omega dt >= this
constexpr double kCancellation = 10;  // u beta s_mean <= this times (omega dt)^2
// In single precision:
constexpr double kNonlinear = 0.02;    // beta s_row (omega dt)^3 <= this
constexpr double kOnePass = 2e-7;      // beta s_min (omega dt)^4 >= this
constexpr double kRoundedMass = 1e-2;  // u beta s_mean <= this

struct Bounds {
  double slowest, singular;  // of beta from below
  double newton, rounding;   // and from above

  [[nodiscard]] double lower() const { return std::max(slowest, singular); }
  [[nodiscard]] double upper() const { return std::min(newton, rounding); }
};

}  // namespace

PenaltyWindow penalty_window(const Model& model, const Structure& structure, double smallest,
                             const StepSettings& settings) {
  PenaltyWindow window;
  const double step = settings.step;
  const bool single = settings.precision == Precision::single_precision;
  // A mechanism at rest without forces says nothing: let it turn once in 1000 steps.
  const Turning fastest = fastest_turning(model);
  window.rate = fastest.rate > 0.0 ? fastest.rate : 2e-3 * std::numbers::pi / step;
  const double turn = window.rate * step;  // rad a step
  const double row = least_constraint_diagonal(model);
  if (structure.singular.value_or(true)) {
    smallest = std::numeric_limits<double>::infinity();  // it says nothing there
  }
  const double mean = mean_constraint_eigenvalue(model);
  const double unit = unit_roundoff(settings.precision);
  const auto bounds_at = [&](double turned) {
    return Bounds{.slowest = single ? kOnePass / (smallest * std::pow(turned, 4))
                                    : kSlowestMode / (smallest * turned),
                  .singular = kSingular / (row * turned),
                  .newton = single ? kNonlinear / (row * std::pow(turned, 3))
                                   : std::numeric_limits<double>::infinity(),
                  .rounding = single ? kRoundedMass / (unit * mean)
                                     : kCancellation * turned * turned / (unit * mean)};
  };
  const Bounds bounds = bounds_at(turn);
  if (single) {
    // At the turn a step where both upper bounds meet; the slowest mode's bound falls faster than
    // they do: at that where it meets the other lower one, if that is longer.
    const double longer = std::max(std::cbrt(bounds.newton / bounds.rounding),
                                   std::cbrt(bounds.slowest / bounds.singular));
    const Bounds widest = bounds_at(turn * longer);
    window.widest = widest.upper() / widest.lower();
  }
  window.slowest_mode = bounds.slowest > bounds.singular;
  window.cancellation = bounds.rounding < bounds.newton;
  const double per_beta = 4.0 / (step * step);
  window.lower = per_beta * bounds.lower();
  window.upper = per_beta * bounds.upper();
  window.stable = per_beta / smallest;
  return window;
}

}  // namespace mbs
