// Estimates against settings.
#include "describe/warnings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "model_math/jacobian_rank.hpp"
#include "model_math/kinematics.hpp"
#include "model_math/spring_diagonal.hpp"
#include "printable.hpp"
#include "run/constraint_force.hpp"
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

bool is_force(const Output& output) { return output.kind == Output::Kind::constraint_force; }

/// Whether these forces are the same for all lambda with the same Phi_q^T lambda: their
/// coefficients are in the range of Phi_q, whose `entries` and `rank` these are.
bool are_determined(const Scene& scene, std::span<const Output* const> outputs, State state,
                    const std::vector<JacobianEntry>& entries, int rank) {
  const Model& model = scene.model;
  SceneMotion motion(scene);
  motion.set(0.0, state);
  state.lambda.assign(static_cast<std::size_t>(model.constraints()), 0.0);
  std::vector<JacobianEntry> with_forces = entries;
  int col = model.variables();
  for (const Output* output : outputs) {
    for (const int row : output->rows) {
      double& lambda = state.lambda[static_cast<std::size_t>(row)];
      lambda = 1.0;
      const Vector3 by_row = output->force == Output::Force::vector
                                 ? constraint_vector(scene, motion, state, *output)
                                 : Vector3{constraint_scalar(scene, motion, state, *output)};
      lambda = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        with_forces.push_back({row, col + axis, by_row[static_cast<std::size_t>(axis)]});
      }
    }
    col += 3;
  }
  std::ranges::stable_sort(with_forces, {}, &JacobianEntry::row);
  const auto found = find_rank(model.constraints(), col, with_forces);
  return !found || found->rank == rank;
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

std::string force_warning(const Scene& scene) {
  const Model& model = scene.model;
  const int rows = model.constraints(), cols = model.variables();
  if (cols > kMostVariablesToWarn || std::ranges::none_of(scene.elements.outputs, is_force))
    return "";
  const auto q = model.initial_position(), v = model.initial_velocity();
  const std::vector<JacobianEntry> entries = jacobian(model, 0.0, q);
  const auto own = find_rank(rows, cols, entries);
  if (!own || own->dependent.empty()) return "";
  const State start{{q.begin(), q.end()}, {v.begin(), v.end()}, {}, {}, 0.0};
  std::vector<const Output*> forces;
  for (const Output& output : scene.elements.outputs) {
    if (is_force(output)) forces.push_back(&output);
  }
  std::span<const Output* const> left = forces;
  const auto determined = [&](std::span<const Output* const> some) {
    return are_determined(scene, some, start, entries, own->rank);
  };
  constexpr std::size_t kMostNamed = 3;
  std::vector<std::string> open;
  while (!determined(left)) {
    if (open.size() == kMostNamed) {
      open.emplace_back("and others");
      break;
    }
    std::size_t begin = 0, end = left.size();  // among these is the first that is open
    while (end - begin > 1) {
      const std::size_t middle = (begin + end) / 2;
      (determined(left.subspan(begin, middle - begin)) ? begin : end) = middle;
    }
    open.push_back(in_quotes(left[begin]->name));
    left = left.subspan(begin + 1);
  }
  if (open.empty()) return "";
  return fmt::format(
      "outputs {}: constraints depend on each other at the start (mbs describe), so that these are "
      "forces that hold the motion, but not the only ones",
      fmt::join(open, ", "));
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
