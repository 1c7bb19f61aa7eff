// Estimates against settings.
#include "describe/warnings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "model_math/kinematics.hpp"
#include "model_math/spring_diagonal.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "scene/row_names.hpp"

namespace mbs {
namespace {

/// upper / lower of a window that is worth a warning when it is no wider.
double least_width(const PenaltyWindow& window) {
  return window.slowest_mode ? kClosedBySlowestInSingle : kClosedInSingle;
}

/// In single precision, where no penalty factor of the user's own is to blame: what to change
/// instead. The bound of the slowest mode recedes faster with longer steps than the nonlinearity
/// comes.
std::string step_warning(const PenaltyWindow& window, const StepSettings& settings) {
  const bool is_long = !window.cancellation && !window.slowest_mode;
  const std::string what = fmt::format(
      "the penalty form on this scene (an estimate: mbs describe): try --scheme saddle-point{}",
      is_long ? "" : ", --precision double");
  if (window.widest < least_width(window)) return "no step suits " + what;
  return fmt::format("the step {:g} s is too {} for {}, or a {} step", settings.step,
                     is_long ? "long" : "short", what, is_long ? "shorter" : "longer");
}

}  // namespace

std::string penalty_warning(const PenaltyWindow& window, const StepSettings& settings,
                            PenaltyFrom from) {
  const auto far = [&](const char* side, double bound, const char* what) {
    return fmt::format(
        "the penalty factor {:.2g} is far {} {:.2g}, the {} at step {:g} s (an "
        "estimate: mbs describe)",
        settings.penalty, side, bound, what, settings.step);
  };
  if (settings.precision == Precision::single_precision) {
    const bool is_spoiled = from == PenaltyFrom::rule && !window.cancellation &&
                            settings.penalty > window.upper * kFarAboveByRule;
    if (is_spoiled || window.upper < window.lower * least_width(window)) {
      return step_warning(window, settings);
    }
  }
  if (from == PenaltyFrom::rule) {
    if (settings.penalty >= window.stable) return "";
    return fmt::format(
        "no penalty factor is large enough for the slowest mode of this scene and small enough for "
        "rounding at step {:g} s (an estimate: mbs describe): the motion may be lost",
        settings.step);
  }
  if (settings.penalty < window.lower / kFarBelow) {
    return far("below", window.lower, "least that is sure to hold the constraints");
  }
  if (settings.penalty > window.upper * kFarAbove) {
    return far("above", window.upper, "most without loss of accuracy");
  }
  return "";
}

double shortest_period(const Model& model) {
  const SpringDiagonal diagonal = spring_diagonal(model);
  const std::vector<double> mass = mass_diagonal(model);
  double fastest = 0.0;  // omega^2, 1/s^2
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const double k = diagonal.stiffness[i], c = diagonal.damping[i];
    if (c * c < 4.0 * k * mass[i]) fastest = std::max(fastest, k / mass[i]);
  }
  return 2.0 * std::numbers::pi / std::sqrt(fastest);
}

std::string period_warning(const Model& model, double step) {
  const double period = shortest_period(model);
  if (step <= kLongestShare * period) return "";
  return fmt::format(
      "the step {:g} s is above a tenth of the shortest period of the springs, {:.2g} "
      "s (an estimate): how they swing is not resolved",
      step, period);
}

std::string tolerance_warning(const Model& model, const StepSettings& settings) {
  const double automatic = automatic_tolerance(model, settings);
  if (settings.tolerance <= kLoosest * automatic) return "";
  return fmt::format(
      "the tolerance {:.2g} m is far above {:.2g}, the automatic one: what Newton leaves in every "
      "step may add up to more than the step's own error (--half-step tells)",
      settings.tolerance, automatic);
}

std::string start_warning(const Model& model, const Structure& structure) {
  if (structure.singular != true) return "";
  return fmt::format(
      "the start is a singular position: {} hold(s) nothing there that others do not (mbs "
      "describe)",
      row_name(model, structure.singular_rows.front()));
}

std::vector<std::string> setting_warnings(const Model& model, const StepSettings& settings,
                                          PenaltyFrom from) {
  std::vector<std::string> result;
  const auto add = [&result](std::string warning) {
    if (!warning.empty()) result.push_back(std::move(warning));
  };
  if (model.constraints() > 0 && model.variables() <= kMostVariablesToWarn) {
    const Structure structure = find_structure(model);
    add(start_warning(model, structure));
    if (settings.scheme == Scheme::penalty) {
      const PenaltyWindow window =
          penalty_window(model, structure,
                         smallest_constraint_eigenvalue(model, model.initial_position()), settings);
      add(penalty_warning(window, settings, from));
    }
  }
  add(tolerance_warning(model, settings));
  add(period_warning(model, settings.step));
  return result;
}

}  // namespace mbs
