// Estimates against settings.
#include "describe/warnings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "model_math/kinematics.hpp"
#include "model_math/vector3.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "scene/row_names.hpp"

namespace mbs {
namespace {

/// A law as a spring, for its period: as stiff as it becomes, as damped as it is at rest. Bump
/// stops are to be resolved although they do not touch at the start.
struct LawAsSpring {
  explicit LawAsSpring(const Law& law) {
    const double factor = law.factor.at(0.0).value;
    stiffness = std::max(0.0, factor * law.by_position.at(0.0).slope);  // straight: no breaks
    for (const double x : law.by_position.breaks) {
      stiffness = std::max(stiffness, factor * law.by_position.at(x).slope);
    }
    damping = std::max(0.0, factor * law.by_rate.at(0.0).slope);
  }
  double stiffness = 0.0, damping = 0.0;
};

/// Diagonals of K and C of Eqs. (11) and (18).
class SpringDiagonal {
 public:
  explicit SpringDiagonal(const Model& model)
      : model_(model),
        stiffness(static_cast<std::size_t>(model.variables()), 0.0),
        damping(stiffness) {
    for (const Spring& spring : model.springs()) add_spring(spring);
    for (const TorsionSpring& spring : model.torsion_springs()) add_torsion_spring(spring);
    for (const ForceLaw& law : model.force_laws()) {
      const LawAsSpring as(law.law);
      // Slack at the start: what a force holds across the line is left out.
      const double length = norm(point(law.a).position - point(law.b).position);
      add_spring({law.a, law.b, as.stiffness, as.damping, length, ""});
    }
    for (const TorqueLaw& law : model.torque_laws()) {
      const LawAsSpring as(law.law);
      add_torsion_spring({law.a, law.b, law.c, law.d, law.axis, as.stiffness, as.damping, 0.0, ""});
    }
  }

 private:
  [[nodiscard]] const Point& point(int index) const {
    return model_.points()[static_cast<std::size_t>(index)];
  }
  void add(int index, const Vector3& k, const Vector3& c) {
    if (point(index).is_fixed()) return;
    for (int axis = 0; axis < model_.dimension(); ++axis) {
      const auto i = static_cast<std::size_t>(point(index).offset + axis);
      stiffness[i] += k[static_cast<std::size_t>(axis)];
      damping[i] += c[static_cast<std::size_t>(axis)];
    }
  }
  void add_spring(const Spring& spring) {
    const Vector3 d = point(spring.a).position - point(spring.b).position;
    const double length = norm(d);
    const Vector3 e = (length > 0.0 ? 1.0 / length : 0.0) * d;
    const double across =
        length > 0.0 ? std::max(0.0, spring.stiffness * (1.0 - spring.length / length)) : 0.0;
    Vector3 k{}, c{};
    for (std::size_t i = 0; i < 3; ++i) {
      k[i] = spring.stiffness * e[i] * e[i] + across * (1.0 - e[i] * e[i]);
      c[i] = spring.damping * e[i] * e[i];
    }
    add(spring.a, k, c);
    add(spring.b, k, c);
  }
  void add_torsion_spring(const TorsionSpring& spring) {
    add_turning(spring, spring.a, spring.b);
    add_turning(spring, spring.c, spring.d);
  }
  void add_turning(const TorsionSpring& spring, int a, int b) {
    const Vector3 w = point(a).position - point(b).position;
    const Vector3 z =
        spring.axis < 0 ? Vector3{0.0, 0.0, 1.0} : Vector3(point(spring.axis).position);
    const Vector3 g = (1.0 / dot(w, w)) * cross(z, w);
    Vector3 k{}, c{};
    for (std::size_t i = 0; i < 3; ++i) {
      k[i] = spring.stiffness * g[i] * g[i];
      c[i] = spring.damping * g[i] * g[i];
    }
    add(a, k, c);
    add(b, k, c);
  }

  const Model& model_;

 public:
  std::vector<double> stiffness, damping;  // N/m, N s/m
};

/// upper / lower of a window that is worth a warning when it is no wider.
double least_width(const PenaltyWindow& window, const StepSettings& settings, PenaltyFrom from) {
  if (settings.precision == Precision::single_precision) {
    return window.slowest_mode ? kClosedBySlowestInSingle : kClosedInSingle;
  }
  return from == PenaltyFrom::rule ? kClosedByRule : 1 / kFarAbove;
}

/// Whether the window is wider at shorter steps. The bound of the slowest mode in single precision
/// recedes faster with longer steps than the nonlinearity comes.
bool is_too_long(const PenaltyWindow& window, const StepSettings& settings) {
  const bool single = settings.precision == Precision::single_precision;
  return !window.cancellation && !(single && window.slowest_mode);
}

/// Where no penalty factor of the user's own is to blame: what to change instead.
std::string step_warning(const PenaltyWindow& window, const StepSettings& settings,
                         PenaltyFrom from) {
  const bool is_long = is_too_long(window, settings);
  const bool no_step = window.widest < least_width(window, settings, from);
  const char* precision =
      is_long || settings.precision == Precision::double_precision ? "" : ", --precision double";
  if (no_step) {
    return fmt::format(
        "no step suits the penalty form on this scene (an estimate: mbs describe): try --scheme "
        "saddle-point{}",
        precision);
  }
  return fmt::format(
      "the step {:g} s is too {} for the penalty form on this scene (an estimate: mbs describe): "
      "try --scheme saddle-point{}, or a {} step",
      settings.step, is_long ? "long" : "short", precision, is_long ? "shorter" : "longer");
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
  if (window.upper < window.lower * least_width(window, settings, from)) {
    return step_warning(window, settings, from);
  }
  if (from == PenaltyFrom::rule) {
    const bool is_spoiled =
        !window.cancellation && settings.penalty > window.upper * kFarAboveByRule;
    return is_spoiled || settings.penalty < window.stable ? step_warning(window, settings, from)
                                                          : "";
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
  const SpringDiagonal diagonal(model);
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
      const PenaltyWindow window = penalty_window(
          model, structure, smallest_constraint_eigenvalue(model, model.initial_position()),
          settings);
      add(penalty_warning(window, settings, from));
    }
  }
  add(tolerance_warning(model, settings));
  add(period_warning(model, settings.step));
  return result;
}

}  // namespace mbs
