// Set back, step, compare.
#include "run/step_again.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

double most_left(const StepSettings& settings) {
  if (settings.tangent != TangentReuse::none) return HUGE_VAL;
  return 4 / settings.step * settings.tolerance;  // Eq. (2), of v + dt/2 a
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
