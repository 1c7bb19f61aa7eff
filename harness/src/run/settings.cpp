// The rules of automatic_settings.md.
#include "run/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "model_math/extent.hpp"
#include "model_math/kinematics.hpp"
#include "model_math/spring_diagonal.hpp"
#include "model_math/turning.hpp"
#include "run/initial_state.hpp"
#include "usage_error.hpp"

namespace mbs {

namespace {

double largest_coordinate(const Model& model) {
  double result = 0.0;
  for (const double x : model.initial_position()) result = std::max(result, std::abs(x));
  return result;
}

}  // namespace

double unit_roundoff(Precision precision) {
  return precision == Precision::single_precision ? std::numeric_limits<float>::epsilon() / 2
                                                  : std::numeric_limits<double>::epsilon() / 2;
}

double rounding_length(const Model& model) {
  return std::min(largest_coordinate(model), extent(model.points()));
}

std::vector<double> constraint_diagonal(const Model& model) {
  const std::vector<double> mass = mass_diagonal(model);
  std::vector<double> diagonal(static_cast<std::size_t>(model.constraints()), 0.0);
  for (const JacobianEntry& entry : jacobian(model, 0.0, model.initial_position())) {
    diagonal[static_cast<std::size_t>(entry.row)] +=
        entry.value * entry.value / mass[static_cast<std::size_t>(entry.col)];
  }
  return diagonal;
}

namespace {

constexpr double kMeasuredTurn = 6.8e-3;  // rad a step, at which the measured numbers hold

/// beta s of the slowest mode from which a step of one pass damps it; below 1 such a step makes it
/// grow (automatic_settings.md here).
constexpr double kStable = 2.0;

/// What rounding of Phi moves a Newton step by, m; `stiffness` is beta s of the points that count.
double rounding_noise(const Model& model, const StepSettings& settings, double stiffness) {
  return unit_roundoff(settings.precision) * rounding_length(model) * std::sqrt(1 + stiffness);
}

/// Whether the slowest mode is as slow wherever the mechanism is, as of long ones with leverage:
/// its eigenvalue stays when all coordinates are moved by a thousandth of `length` (m). At a
/// singular position it does not.
bool is_slow_everywhere(const Model& model, double smallest, double length) {
  std::vector<double> q(model.initial_position().begin(), model.initial_position().end());
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] += 1e-3 * length * std::sin(1.0 + static_cast<double>(i * i % 1009));
  }
  return smallest_constraint_eigenvalue(model, q) < 2 * smallest;
}

/// Whether passes converge like Newton's, with a tangent of each. The penalty form's do not in
/// float, nor with a geometric stiffness, into which alpha Phi enters.
bool is_newton(const StepSettings& settings) {
  return settings.tangent == TangentReuse::none &&
         (settings.scheme == Scheme::saddle_point ||
          (settings.scheme == Scheme::penalty && !settings.geometric_stiffness &&
           settings.precision == Precision::double_precision));
}

/// beta = alpha dt^2/4 of the penalty form with kept tangents or factors in float, kg/m^2.
double automatic_beta(const Model& model, const StepSettings& settings, double smallest) {
  // The coarse tolerance of single precision leaves the multipliers one pass a step, which needs
  // more beta from longer steps on.
  const bool single = settings.precision == Precision::single_precision;
  const double at = single ? 2 * kMeasuredTurn : kMeasuredTurn;
  const double mean = mean_constraint_eigenvalue(model);
  const Turning fastest = fastest_turning(model);
  double measured = std::clamp(30 / smallest, 4e3 / mean, 1e7 / mean);
  constexpr double kQuiet = 3e-9;  // of the length
  const double stable = kStable / smallest, least = least_constraint_diagonal(model);
  if (stable > measured &&
      rounding_noise(model, settings, stable * least) <= kQuiet * fastest.length) {
    measured = stable;
  }
  const double turn = fastest.rate * settings.step;
  if (turn == 0.0) return measured;
  const double ratio = turn / at;
  if (ratio <= 1.0)
    return std::min(measured / (ratio * ratio), std::max(measured, (single ? 6e4 : 4e6) / mean));
  const double nonlinear = 0.6 / (least * std::pow(turn, 3));
  return std::max(std::min(measured, nonlinear), measured / 100);
}

}  // namespace

double mean_constraint_eigenvalue(const Model& model) {
  const std::vector<double> diagonal = constraint_diagonal(model);
  return std::accumulate(diagonal.begin(), diagonal.end(), 0.0) / model.constraints();
}

double least_constraint_diagonal(const Model& model) {
  double least = std::numeric_limits<double>::infinity();
  for (const double value : constraint_diagonal(model)) {
    if (value > 0.0) least = std::min(least, value);
  }
  return least;
}

double automatic_penalty(const Model& model, const StepSettings& settings,
                         std::optional<double> smallest) {
  if (model.constraints() == 0) return 1.0;
  const double per_beta = 4 / (settings.step * settings.step);
  const auto slowest = [&] {
    return smallest ? *smallest : smallest_constraint_eigenvalue(model, model.initial_position());
  };
  const bool is_penalty = settings.scheme == Scheme::penalty;
  if (is_penalty && !is_newton(settings)) {
    return per_beta * automatic_beta(model, settings, slowest());
  }
  const double mean = mean_constraint_eigenvalue(model);
  if (settings.scheme == Scheme::multistep6) return per_beta * 1e7 / mean;
  const bool is_rattle = !is_penalty && settings.scheme != Scheme::saddle_point;
  if (is_rattle) return per_beta * 2e4 / mean;
  if (settings.precision != Precision::double_precision) return per_beta * 1e6 / mean;
  const Turning fastest = fastest_turning(model);
  const double ratio = fastest.rate > 0 ? fastest.rate * settings.step / kMeasuredTurn : 1.0;
  const double s_min = slowest();
  // In the penalty form light parts, which make the mean large, are no measure: their own masses
  // may be rounded in T as long as something is left of them.
  constexpr double kLeft = 1e14;
  const double row = is_penalty ? least_constraint_diagonal(model) : mean;
  const double most = std::max(1e10 / mean, std::min(1e10 / row, kLeft / mean));
  // No more than it takes: lambda has the rounding of Phi times alpha.
  const double least = (is_penalty ? 1e6 : 2.5e7) / mean;
  const double measured = std::clamp(15 / (s_min * ratio * ratio), least, most);
  const double stable = kStable / s_min;
  if (stable <= measured) return per_beta * measured;
  // From kRounded on T rounds M of heavy parts, which singular positions amplify.
  constexpr double kRounded = 1e12;
  const double reached = (is_penalty ? 6e13 : 1e14) / mean;
  const bool is_in_reach = stable <= reached && (!is_penalty || stable <= kRounded / row ||
                                                 is_slow_everywhere(model, s_min, fastest.length));
  return per_beta * (is_in_reach ? stable : measured);
}

namespace {

/// Whether a step is longer than 2 m/c of some coordinate. Then the trapezoidal rule turns what is
/// wrong in its speed round in each step, and hardly damps it.
bool has_stiff_damper(const Model& model, double step) {
  const std::vector<double> mass = mass_diagonal(model), damping = spring_diagonal(model).damping;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (step * damping[i] > 2 * mass[i]) return true;
  }
  return false;
}

}  // namespace

double automatic_tolerance(const Model& model, const StepSettings& settings) {
  constexpr double kLinear = 5e5;  // beta s_mean of the penalty form, from which it hardly shows
  const double step = settings.step;
  double length = 1.0;
  for (const double its : part_lengths(model)) length = std::min(length, its);
  const double stiffness = model.constraints() == 0 ? 0.0
                                                    : settings.penalty * step * step / 4 *
                                                          mean_constraint_eigenvalue(model);
  // Newton converges quadratically: what it leaves is far below the last |Delta q|. But a small
  // penalty factor makes that linear, and a stiff damper makes even little a force.
  const bool is_quadratic = is_newton(settings) && !has_stiff_damper(model, step) &&
                            (settings.scheme == Scheme::saddle_point || stiffness >= kLinear);
  const double of_paper = step / 1.25e-3;
  const double wanted =
      length *
      std::min(is_quadratic ? 1e-8 * std::pow(of_paper, 2) : 1e-9 * std::pow(of_paper, 4), 1e-6);
  return std::max({wanted, 10 * rounding_noise(model, settings, stiffness),
                   10 * unit_roundoff(settings.precision) * largest_coordinate(model)});
}

StepSettings chosen(const Model& model, StepSettings settings, std::optional<double> smallest) {
  if (settings.penalty == 0.0) {
    settings.penalty = automatic_penalty(model, settings, smallest);
    if (!(settings.penalty > 0.0) || !std::isfinite(settings.penalty)) {
      throw UsageError(
          fmt::format("--penalty auto gives {:g} for this scene and step {:g} s: its "
                      "lengths or masses are out of range; name a number",
                      settings.penalty, settings.step));
    }
  }
  if (settings.tolerance == 0.0) settings.tolerance = automatic_tolerance(model, settings);
  return settings;
}

double parse_automatic(const char* option, const std::string& text, const char* what) {
  if (text == "auto") return 0.0;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) ||
      !(value > 0.0)) {
    throw UsageError(
        fmt::format("{} is '{}': it must be 'auto' or a number above 0{}", option, text, what));
  }
  return value;
}

}  // namespace mbs
