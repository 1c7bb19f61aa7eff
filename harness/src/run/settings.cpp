// The rule for alpha.
#include "run/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "model_math/kinematics.hpp"
#include "run/initial_state.hpp"
#include "usage_error.hpp"

namespace mbs {

double automatic_penalty(const Model& model, double step) {
  if (model.constraints() == 0) return 1.0;
  std::vector<double> lumped(static_cast<std::size_t>(model.variables()));
  for (const MassEntry& entry : model.mass()) {
    if (entry.row == entry.col) lumped[static_cast<std::size_t>(entry.row)] = entry.value;
  }
  double trace = 0.0;
  for (const JacobianEntry& entry : jacobian(model, model.initial_position())) {
    trace += entry.value * entry.value / lumped[static_cast<std::size_t>(entry.col)];
  }
  const double mean = trace / model.constraints();
  const double smallest = smallest_constraint_eigenvalue(model, model.initial_position());
  return 4 / (step * step) * std::clamp(30 / smallest, 4e3 / mean, 1e7 / mean);
}

double parse_penalty(const std::string& text, const Model& model, double step) {
  if (text == "auto") return automatic_penalty(model, step);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) ||
      !(value > 0.0)) {
    throw UsageError(fmt::format("--penalty is '{}': it must be 'auto' or a number above 0", text));
  }
  return value;
}

double automatic_tolerance(double step) {
  return std::clamp(1e-9 * std::pow(step / 1.25e-3, 4), 1e-13, 1e-6);
}

}  // namespace mbs
