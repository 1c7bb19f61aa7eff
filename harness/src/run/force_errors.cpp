// The same outputs of three states.
#include "run/force_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model_math/kinematics.hpp"
#include "model_math/largest.hpp"
#include "printable.hpp"
#include "run/initial_state.hpp"
#include "run/judge.hpp"
#include "scene/output_columns.hpp"

namespace mbs {

ForceErrors::ForceErrors(const Scene& scene) : scene_(scene), outputs_(scene) {
  std::size_t column = 0;
  for (const Output& output : scene.elements.outputs) {
    const std::size_t columns = columns_of(output, scene.model.dimension()).size();
    if (output.kind == Output::Kind::acceleration ||
        output.kind == Output::Kind::constraint_force) {
      asked_.push_back({&output.name, column, columns});
    }
    column += columns;
  }
}

std::vector<double> ForceErrors::values(double t, const State& state) {
  outputs_.follow(t, state);
  return outputs_.values();
}

/// `right` with its largest acceleration everywhere, and each row bearing the largest force.
State ForceErrors::largest(double t, const State& right) const {
  const Model& model = scene_.model;
  State state = right;
  std::ranges::fill(state.a, largest_of(right.a));
  std::vector<double> force(right.q.size()), gradient(right.lambda.size(), 0.0);
  applied_force(model, t, right.q, right.v, force);
  double most = largest_of(force);
  for (const JacobianEntry& entry : jacobian(model, t, right.q)) {
    double& largest = gradient[static_cast<std::size_t>(entry.row)];
    largest = std::max(largest, std::abs(entry.value));
  }
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    most = std::max(most, gradient[k] * std::abs(right.lambda[k]));
  }
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    if (gradient[k] > 0.0) state.lambda[k] = most / gradient[k];
  }
  return state;
}

void ForceErrors::compare(double t, const State& state) {
  constexpr double kSmall = 1e-3;  // outputs that are next to nothing may be nothing but noise
  const State right = consistent_state(scene_.model, state.q, state.v, t, state.lambda);
  const std::vector<double> found = values(t, state), expected = values(t, right),
                            most = values(t, largest(t, right));
  for (Asked& one : asked_) {
    double off = 0.0, size = 0.0, scale = 0.0;
    for (std::size_t i = one.column; i < one.column + one.columns; ++i) {
      off = std::hypot(off, found[i] - expected[i]);
      size = std::hypot(size, expected[i]);
      scale = std::hypot(scale, most[i]);
    }
    one.off = std::isnan(off) ? HUGE_VAL : std::max(one.off, off);
    one.largest = std::max({one.largest, size, kSmall * scale});
  }
}

std::string ForceErrors::beyond() const {
  const double allowed = AccurateBounds{}.force;
  const Asked* worst = nullptr;
  for (const Asked& one : asked_) {
    if (one.off <= allowed * one.largest) continue;
    if (worst == nullptr || one.off * worst->largest > worst->off * one.largest) worst = &one;
  }
  if (worst == nullptr) return "";
  return fmt::format("output {} is off by {:.2g} % of its largest value (ok to {:g} %)",
                     in_quotes(*worst->name), 100 * worst->off / worst->largest, 100 * allowed);
}

}  // namespace mbs
