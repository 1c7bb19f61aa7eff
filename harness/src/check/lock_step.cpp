// Differences in units of what rounding explains.
#include "check/lock_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "run/settings.hpp"

namespace mbs {
namespace {

using Values = std::vector<double>;

double largest(const Values& x) {
  double worst = 0.0;
  for (const double value : x) worst = std::max(worst, std::abs(value));
  return worst;
}

}  // namespace

double largest_difference(const Values& x, const Values& y) {
  if (x.size() != y.size()) return std::numeric_limits<double>::quiet_NaN();
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double difference = std::abs(x[i] - y[i]);
    if (!std::isfinite(difference)) return std::numeric_limits<double>::quiet_NaN();
    worst = std::max(worst, difference);
  }
  return worst;
}

LockStepTolerance lock_step_tolerance(const Probe& probe, const StepSettings& settings) {
  constexpr double kSafety = 4.0;
  const double unit = unit_roundoff(settings.precision);
  const double h = settings.step;
  const double size = std::max(largest(probe.after.q), 1e-300);
  const double growth = kSafety * unit * probe.outcome.passes * std::sqrt(probe.condition);
  // Factors in single precision make Newton converge along another way.
  const double left = settings.precision == Precision::mixed ? settings.tolerance : 0.0;
  const double q = growth * size + left;
  const double phi = probe.jacobian_norm * (unit * size + left);  // what that does to Phi
  return {q, 2 / h * q, 4 / (h * h) * q,
          kSafety *
              (probe.outcome.passes * settings.penalty * phi + unit * largest(probe.after.lambda))};
}

double most_allowed(const StepSettings& settings) {
  return settings.precision == Precision::double_precision ? 1e-6 : 1e-2;
}

FreeRunningTolerance free_running_tolerance(const Probe& probe, const StepSettings& settings,
                                            double extent) {
  const double length = std::min(extent, 1.0);
  if (settings.precision == Precision::single_precision) return {1e-2 * length, 1.0, false};
  // Where max |Delta q| comes to lie at the tolerance, rounding decides on one more pass.
  constexpr double kSeldom = 0.005, kOften = 0.2;
  const double step = lock_step_tolerance(probe, settings).q;
  if (step > 1e-8 * length) {
    return {std::min(100 * step, most_allowed(settings) * extent), kOften, false};
  }
  return {1e-7 * length, kSeldom, true};
}

void LockStep::add(const Probe& probe, const StepSettings& settings, const StepOutcome& outcome,
                   const State& state, const std::string& whose) {
  if (failed_) return;
  if (outcome.status == StepStatus::factorization_failed) {
    failed_ = true;
    worst_ = std::numeric_limits<double>::infinity();
    detail_ = fmt::format("{}factorization failed in the step from t = {:g} s", whose, probe.t);
    return;
  }
  const auto compare = [&](const char* name, const Values& x, const Values& y, double allowed) {
    const double difference = largest_difference(x, y);
    if (difference == 0.0) return;  // nothing is allowed where there is nothing: 0/0
    const double ratio = difference / allowed;
    if (failed_ || ratio <= worst_) return;  // the first NaN stays
    failed_ = std::isnan(ratio);
    worst_ = ratio;
    detail_ = fmt::format("{}{} differs by {:.1e} after one step from t = {:g} s (allowed {:.1e})",
                          whose, name, difference, probe.t, allowed);
  };
  const LockStepTolerance tolerance = lock_step_tolerance(probe, settings);
  compare("q", state.q, probe.after.q, tolerance.q);
  compare("v", state.v, probe.after.v, tolerance.v);
  compare("a", state.a, probe.after.a, tolerance.a);
  compare("lambda", state.lambda, probe.after.lambda, tolerance.lambda);
}

Check LockStep::check() const { return {name_, worst_, 1.0, worst_ <= 1.0, detail_}; }

}  // namespace mbs
