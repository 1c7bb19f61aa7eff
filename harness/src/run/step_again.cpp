// Set back, step, compare.
#include "run/step_again.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model_math/extent.hpp"
#include "model_math/kinematics.hpp"
#include "run/settings.hpp"

namespace mbs {
namespace {

StepSettings cleaned(const Model& model, StepSettings settings, double passes) {
  StepSettings half = settings;
  half.step /= 2;
  half.penalty *= 4;  // the same eps = 4 / (alpha dt^2)
  settings.tangent = TangentReuse::none;
  settings.projections_every = 1;
  settings.tolerance = std::min(settings.tolerance, automatic_tolerance(model, half));
  settings.max_passes = static_cast<int>(std::ceil(passes)) + 2;
  return settings;
}

}  // namespace

double most_left(const Model& model, const StepSettings& settings, double speed) {
  if (settings.scheme != Scheme::penalty || settings.tangent != TangentReuse::none) return HUGE_VAL;
  const double step = settings.step, tolerance = settings.tolerance;
  double factor = 1.0;  // of rows
  for (const BilinearConstraint& c : model.bilinear_constraints()) {
    for (const auto& row : c.B) {
      for (const double entry : row) factor = std::max(factor, std::abs(entry));
    }
  }
  // A distance has 2 u in Phi_q, which a correction of both ends changes by four tolerances; of a
  // row (Phi_q)' v is at most 2 (2 speed)^2 and Phi_t 2 speed times a length.
  const double turned = 4 * tolerance * factor;
  const bool is_driven = !model.driven_points().empty() || !model.driven_values().empty();
  const double rate = is_driven ? 2 * speed * extent(model.points()) : 0.0;
  const double wrong = factor * (rate + step / 2 * 8 * speed * speed);
  const double beta = settings.penalty * step * step / 4;
  return 2 / step * tolerance + beta * turned * wrong / std::ranges::min(mass_diagonal(model));
}

StepAgain::StepAgain(const Create& create, const Model& model, const StepSettings& settings,
                     double passes)
    : step_(settings.step), simulation_(create(cleaned(model, settings, passes))) {}

void StepAgain::advance(const State& from, State& to) {
  simulation_->set_state(from);
  if (simulation_->step().status == StepStatus::factorization_failed) is_done_ = false;
  simulation_->get_state(to);
}

double StepAgain::subtract(const State& x, const State& y, std::vector<double>& faster) const {
  double largest = 0.0;
  faster.resize(x.v.size());
  for (std::size_t i = 0; i < faster.size(); ++i) {
    faster[i] = is_done_ ? x.v[i] - y.v[i] + step_ / 2 * (x.a[i] - y.a[i])
                         : std::numeric_limits<double>::infinity();
    // std::max would drop a NaN.
    largest = std::max(largest, std::isnan(faster[i]) ? HUGE_VAL : std::abs(faster[i]));
  }
  return largest;
}

const SpeedError& StepAgain::error(const State& before, const State& after, double negligible) {
  is_done_ = true;
  advance(before, again_);
  const double largest = subtract(after, again_, error_.now);
  if (largest < negligible || !std::isfinite(largest)) {
    error_.later = error_.now;
    return error_;
  }
  advance(after, later_);
  if (is_done_) advance(again_, again_later_);
  subtract(is_done_ ? later_ : after, is_done_ ? again_later_ : after, error_.later);
  return error_;
}

}  // namespace mbs
