// Three runs from rest to 0.6 s.
#include "check/exact_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "run/run.hpp"
#include "run/stretch.hpp"

namespace mbs {
namespace {

constexpr double kDuration = 0.6;  // s; the first singular position comes at 0.708 s or later
/// Position error over dt^2, m/s^2. Measured: 0.593 at N = 1 falling to 0.537 with the trapezoidal
/// rule, 1.309 falling to 1.205 with RATTLE.
double error_constant(Scheme scheme) { return scheme == Scheme::rattle ? 1.45 : 0.65; }

/// Why these settings have no error of second order to be checked; empty if they have.
std::string why_not(const StepSettings& settings) {
  if (settings.scheme == Scheme::rattle4 || settings.scheme == Scheme::rattle6 ||
      settings.scheme == Scheme::multistep6) {
    return "a scheme of higher order is at rounding at such steps";
  }
  if (settings.precision == Precision::single_precision) return "single precision rounds more";
  if (settings.tangent == TangentReuse::kept) {
    return "with kept factors the error is what Newton leaves";
  }
  return "";
}

RunSummary run_with_step(const Scene& scene, const Variant& variant, const StepSettings& base,
                         double factor) {
  StepSettings settings = base;
  settings.step = factor * base.step;
  settings.penalty = base.penalty / (factor * factor);
  settings.tolerance = 0.1 * base.tolerance * std::pow(factor, 4);
  RunSettings run_settings;
  run_settings.step = settings;
  run_settings.duration = kDuration;
  return run(scene, variant, run_settings);
}

}  // namespace

namespace {

/// Errors at 4 dt, 2 dt and dt, m, against second order.
Check order_check(const std::vector<double>& errors, double step) {
  const double first = std::log2(errors[0] / errors[1]);
  const double second = std::log2(errors[1] / errors[2]);
  const double worst = std::max(std::abs(first - 2), std::abs(second - 2));
  return {"convergence-order", worst, 0.1, worst <= 0.1,
          fmt::format("from 2; order {:.3f} then {:.3f} over steps of {:g}, {:g} and {:g} s", first,
                      second, 4 * step, 2 * step, step)};
}

}  // namespace

std::vector<Check> exact_checks_not_run(const std::string& reason) {
  return {{"exact", {}, {}, {}, reason}, {"convergence-order", {}, {}, {}, reason}};
}

std::vector<Check> exact_checks(const Scene& scene, const Variant& variant,
                                const StepSettings& settings) {
  const std::string unsuited = why_not(settings);
  if (!unsuited.empty()) return exact_checks_not_run(unsuited);
  const double step = settings.step;
  constexpr double kCoarsest = 0.02;  // s; above it second order is not yet visible
  if (4 * step > kCoarsest) {
    return exact_checks_not_run(
        fmt::format("four times the step of {:g} s is above {:g} s", step, kCoarsest));
  }
  constexpr double kFinest = 1e-5;  // s; below it the runs would take too long
  if (step < kFinest) {
    return exact_checks_not_run(fmt::format("the step of {:g} s is below {:g} s", step, kFinest));
  }
  const bool order_visible = *scene.four_bar_loops <= kMostLoopsToCross;
  std::vector<double> errors;
  for (const double factor : order_visible ? std::vector{4.0, 2.0, 1.0} : std::vector{1.0}) {
    const RunSummary summary = run_with_step(scene, variant, settings, factor);
    if (!is_finished(summary.status)) {
      return {
          {"exact", {}, {}, false, fmt::format("step {:g} s: {}", factor * step, summary.reason)}};
    }
    errors.push_back(*summary.position_error_max);
  }
  const double allowed = error_constant(settings.scheme) * step * step;
  const Check exact{"exact", errors.back(), allowed, errors.back() <= allowed,
                    fmt::format("position error over {:g} s, m", kDuration)};
  if (!order_visible) {
    return {exact,
            {"convergence-order",
             {},
             {},
             {},
             fmt::format("above N = {} no three steps lie in the safe range of (alpha, dt)",
                         kMostLoopsToCross)}};
  }
  return {exact, order_check(errors, step)};
}

}  // namespace mbs
