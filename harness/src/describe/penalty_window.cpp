// Four bounds on alpha, two from below and two from above.
#include "describe/penalty_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "describe/shortest_lengths.hpp"
#include "model_math/kinematics.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"

namespace mbs {
namespace {

// With beta = alpha dt^2/4 and omega the rate of turning; fitted, see README.md here.
constexpr double kSlowestMode = 0.1;   // beta s_min omega dt >= this
constexpr double kSingular = 3.0;      // beta s_row omega dt >= this
constexpr double kNonlinear = 0.02;    // beta s_row (omega dt)^3 <= this
constexpr double kCancellation = 0.4;  // u l_r sqrt(beta s_mean) <= this times l (omega dt)^4

struct Turning {
  double rate = 0.0;    // omega, 1/s
  double length = 1.0;  // l of the point that turns fastest, m
};

/// The fastest of all points: what it moves at now, or after falling freely by the shortest length
/// at it, over that length.
Turning fastest_turning(const Model& model) {
  const auto n = static_cast<std::size_t>(model.variables());
  const std::vector<double> mass = mass_diagonal(model);
  std::vector<double> force(n);
  applied_force(model, 0.0, model.initial_position(), model.initial_velocity(), force);
  const std::vector<double> length = shortest_lengths(model);
  Turning result;
  for (std::size_t k = 0; k < length.size(); ++k) {
    const Point& point = model.points()[k];
    if (point.is_fixed() || length[k] == 0.0) continue;
    double speed = 0.0, acceleration = 0.0;
    for (int axis = 0; axis < model.dimension(); ++axis) {
      const auto i = static_cast<std::size_t>(point.offset + axis);
      speed = std::hypot(speed, model.initial_velocity()[i]);
      acceleration = std::hypot(acceleration, force[i] / mass[i]);
    }
    const double rate = std::max(speed / length[k], std::sqrt(2.0 * acceleration / length[k]));
    if (rate > result.rate) result = {rate, length[k]};
  }
  return result;
}

/// s_row: the least of the diagonal of Phi_q M^-1 Phi_q^T with the diagonal of M, m^2/kg: the
/// heaviest that a constraint moves. Light unit vectors make the mean a hundred times as much.
double least_row(const Model& model) {
  const std::vector<double> mass = mass_diagonal(model);
  std::vector<double> diagonal(static_cast<std::size_t>(model.constraints()), 0.0);
  for (const JacobianEntry& entry : jacobian(model, 0.0, model.initial_position())) {
    diagonal[static_cast<std::size_t>(entry.row)] +=
        entry.value * entry.value / mass[static_cast<std::size_t>(entry.col)];
  }
  double least = std::numeric_limits<double>::infinity();
  for (const double value : diagonal) {
    if (value > 0.0) least = std::min(least, value);
  }
  return least;
}

}  // namespace

PenaltyWindow penalty_window(const Model& model, const Structure& structure, double step) {
  PenaltyWindow window;
  // A mechanism at rest without forces says nothing: let it turn once in 1000 steps.
  const Turning fastest = fastest_turning(model);
  window.rate = fastest.rate > 0.0 ? fastest.rate : 2e-3 * std::numbers::pi / step;
  const double turn = window.rate * step;  // rad a step
  const double row = least_row(model);
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
  window.slowest_mode = for_slowest > for_singular;
  window.cancellation = for_rounding < for_newton;
  const double per_beta = 4.0 / (step * step);
  window.lower = per_beta * std::max(for_slowest, for_singular);
  window.upper = per_beta * std::min(for_newton, for_rounding);
  window.automatic = automatic_penalty(model, {.step = step});
  return window;
}

}  // namespace mbs
