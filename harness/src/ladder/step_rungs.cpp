// One step of the reference and one of the other, part by part.
#include "ladder/step_rungs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model_math/largest.hpp"
#include "reference/reference_simulation.hpp"
#include "scene/row_names.hpp"

namespace mbs {
namespace {

using Look = StepRung::Look;

constexpr double kAllowed = 1e-6;     ///< of the largest entry
constexpr double kEvaluated = 3e-12;  ///< the same of f and T, which nothing amplifies

enum class Shape { variables, constraints, jacobian, tangent };

/// What a rung looks at, of one simulation.
struct Quantity {
  std::string name;
  Shape shape;
  std::vector<double> values;
};

struct Looked {
  bool is_shown = true;
  StepOutcome outcome = {StepStatus::pass_limit, 1};
  std::vector<Quantity> quantities;
};

Looked look_at_first_pass(const std::string& rung, Simulation& simulation) {
  FirstPass pass;
  Looked looked;
  looked.is_shown = simulation.show_first_pass(pass);
  if (rung == "predict") {
    looked.quantities = {{"q'", Shape::variables, pass.q},
                         {"v'", Shape::variables, pass.v},
                         {"a'", Shape::variables, pass.a}};
  } else if (rung == "Phi") {
    looked.quantities = {{rung, Shape::constraints, pass.Phi}};
  } else if (rung == "Phi_q") {
    looked.quantities = {{rung, Shape::jacobian, pass.Phi_q}};
  } else if (rung == "f") {
    looked.quantities = {{rung, Shape::variables, pass.f}};
  } else {
    looked.quantities = {{rung, Shape::tangent, pass.T}};
  }
  return looked;
}

/// `predicted` is the reference's q', for Delta q.
Looked look(const StepRung& rung, const Maker& make, StepSettings settings, const State& state,
            const std::vector<double>& predicted) {
  settings.max_passes = 1;
  settings.projections = rung.look == Look::velocity ? Projections::velocity
                         : rung.look == Look::both   ? Projections::both
                                                     : Projections::none;
  const auto simulation = make(settings);
  simulation->set_state(state);
  if (rung.look == Look::shown) return look_at_first_pass(rung.name, *simulation);
  Looked looked;
  looked.outcome = simulation->step();
  State after;
  simulation->get_state(after);
  if (rung.name == "lambda") {
    looked.quantities = {{rung.name, Shape::constraints, after.lambda}};
    return looked;
  }
  if (rung.name == "Delta q") {
    std::vector<double> delta = after.q;
    for (std::size_t i = 0; i < std::min(delta.size(), predicted.size()); ++i) {
      delta[i] -= predicted[i];
    }
    looked.quantities.push_back({rung.name, Shape::variables, delta});
  }
  const char* when = rung.look == Look::one_pass ? " after the pass" : " after the projection";
  looked.quantities.push_back({std::string("v'") + when, Shape::variables, after.v});
  if (rung.look != Look::velocity) {
    looked.quantities.push_back({std::string("a'") + when, Shape::variables, after.a});
  }
  return looked;
}

/// What entry `i` is called.
std::string entry_name(const Model& model, Shape shape, std::size_t i) {
  const auto n = static_cast<std::size_t>(model.variables());
  const auto variable = [&](std::size_t k) { return variable_name(model, static_cast<int>(k)); };
  const auto constraint = [&](std::size_t k) {
    return fmt::format("row {} ('{}')", k, row_name(model, static_cast<int>(k)));
  };
  switch (shape) {
    case Shape::variables:
      return variable(i);
    case Shape::constraints:
      return constraint(i);
    case Shape::jacobian:
      return fmt::format("{}, column {} ({})", constraint(i / n), i % n, variable(i % n));
    case Shape::tangent:
      return fmt::format("row {} ({}), column {} ({})", i / n, variable(i / n), i % n,
                         variable(i % n));
  }
  return "";
}

/// What may be allowed of a projected a': it is a* and a solved change, which off the constraints
/// are thousands of times larger and cancel; an error of T's solution is a share of that.
double allowed_of_projected(const Maker& make, StepSettings settings, const State& state) {
  settings.max_passes = 1;
  settings.projections = Projections::velocity;
  const auto simulation = make(settings);
  simulation->set_state(state);
  (void)simulation->step();
  State after;
  simulation->get_state(after);
  return kAllowed * largest_of(after.a);
}

/// The number that makes all of y all of x, to 1e-6; NaN if there is none.
double common_factor(const std::vector<double>& x, const std::vector<double>& y, double allowed) {
  double factor = std::numeric_limits<double>::quiet_NaN(), largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::abs(y[i]) > largest) largest = std::abs(y[i]), factor = x[i] / y[i];
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(std::abs(x[i] - factor * y[i]) <= kAllowed * largest + allowed)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }
  return factor;
}

std::optional<double> number(double x) {
  return std::isfinite(x) ? std::optional(x) : std::nullopt;
}

/// The lower half alone: what is above it counts as right.
void mirror(std::vector<double>& T, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) T[i * n + j] = T[j * n + i];
  }
}

/// At most `allowed` apart.
std::optional<Finding> compare(const Model& model, Quantity ours, const Quantity& expected,
                               double allowed) {
  const std::vector<double>& y = expected.values;
  if (ours.values.size() != y.size()) {
    return Finding{ours.name,
                   "",
                   {},
                   {},
                   fmt::format("it has {} entries and must have {}", ours.values.size(), y.size())};
  }
  if (ours.shape == Shape::tangent) {
    mirror(ours.values, static_cast<std::size_t>(model.variables()));
  }
  const std::vector<double>& x = ours.values;
  const auto differs = [&](std::size_t i) { return !(std::abs(x[i] - y[i]) <= allowed); };
  std::size_t count = 0, worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!differs(i)) continue;
    const bool is_worse = !(std::abs(x[i] - y[i]) <= std::abs(x[worst] - y[worst]));
    if (count == 0 || (is_worse && std::isfinite(x[worst]))) worst = i;
    ++count;
  }
  if (count == 0) return {};
  std::string detail = fmt::format("{} of {} entries differ", count, x.size());
  const double factor = common_factor(x, y, allowed);
  if (factor == 0.0) {
    detail += ": all are zero, as if nothing had been computed";
  } else if (std::abs(factor - 1.0) > 1e-5) {
    detail += fmt::format(": all are {:.6g} times the reference's", factor);
  }
  return Finding{ours.name, entry_name(model, ours.shape, worst), number(x[worst]),
                 number(y[worst]), detail};
}

}  // namespace

std::optional<Finding> compare_values(const Model& model, const std::string& name,
                                      const std::vector<double>& x, const std::vector<double>& y,
                                      double allowed) {
  const Shape shape = name == "lambda" ? Shape::constraints : Shape::variables;
  return compare(model, {name, shape, x}, {name, shape, y}, allowed);
}

State moved_state(const Model& model, State state, double penalty) {
  constexpr double kAway = 1e-4;  // m
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    const auto x = static_cast<double>(i);
    state.q[i] += kAway * std::sin(x + 1);
    state.v[i] += std::cos(1.7 * x);
    state.a[i] += std::sin(2.3 * x + 0.4);
  }
  for (int k = 0; k < model.constraints(); ++k) {
    state.lambda[static_cast<std::size_t>(k)] += kAway * penalty * std::cos(1.3 * k + 0.4);
  }
  return state;
}

Compared compare_step(const StepRung& rung, const Maker& make, const Model& model,
                      const StepSettings& settings, const State& state) {
  const Maker reference = [&](const StepSettings& one) {
    return std::make_unique<ReferenceSimulation>(model, one);
  };
  FirstPass predicted;
  const auto first = reference(settings);
  first->set_state(state);
  if (!first->show_first_pass(predicted)) throw std::logic_error("no first pass to compare with");
  const Looked expected = look(rung, reference, settings, state, predicted.q);
  Looked ours = look(rung, make, settings, state, predicted.q);
  if (!ours.is_shown) return {false, {}};
  if (ours.outcome.status == StepStatus::factorization_failed) {
    return {true, Finding{"T", "", {}, {}, "its factorization failed; it is positive definite"}};
  }
  for (std::size_t i = 0; i < expected.quantities.size(); ++i) {
    Quantity& quantity = ours.quantities[i];
    if (rung.look == Look::shown && quantity.values.empty() &&
        !expected.quantities[i].values.empty()) {
      return {false, {}};
    }
    const Quantity& right = expected.quantities[i];
    double allowed = kAllowed * largest_of(right.values);
    if (rung.name == "f" || rung.name == "T") allowed = kEvaluated * largest_of(right.values);
    if (rung.look == Look::both && quantity.name.starts_with("a'")) {
      allowed = allowed_of_projected(reference, settings, state);
    }
    const auto finding = compare(model, std::move(quantity), right, allowed);
    if (finding) return {true, finding};
  }
  if (ours.outcome.status != expected.outcome.status || ours.outcome.passes != 1) {
    return {true,
            Finding{"passes",
                    "",
                    {},
                    {},
                    "with max_passes = 1 and max |Delta q| above the tolerance, a step does one "
                    "pass and ends with pass_limit"}};
  }
  return {};
}

}  // namespace mbs
