// One pass over the Jacobian at the start.
#include "run/rounding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "model_math/kinematics.hpp"
#include "scene/row_names.hpp"

namespace mbs {

std::string rounding_degradation(const Model& model, const StepSettings& settings, long steps,
                                 double length) {
  if (settings.scheme != Scheme::penalty || settings.precision == Precision::single_precision) {
    return "";
  }
  constexpr double kAllowed = 0.1;
  const auto entries = jacobian(model, 0.0, model.initial_position());
  std::vector<double> gradient(static_cast<std::size_t>(model.constraints()), 0.0);
  for (const JacobianEntry& entry : entries) {
    double& largest = gradient[static_cast<std::size_t>(entry.row)];
    largest = std::max(largest, std::abs(entry.value));
  }
  std::vector<double> factor(gradient.size(), 1.0);  // largest entry of B
  std::size_t row = model.dot_constraints().size();
  for (const BilinearConstraint& c : model.bilinear_constraints()) {
    double& largest = factor[row++] = 0.0;
    for (const auto& line : c.B) {
      for (const double entry : line) largest = std::max(largest, std::abs(entry));
    }
  }
  const std::vector<double> mass = mass_diagonal(model);
  const double walk =
      settings.step * settings.step * std::pow(static_cast<double>(steps), 1.5) / std::sqrt(3.0);
  const double round = settings.penalty * std::numeric_limits<double>::epsilon();
  double most = 0.0;
  int worst = 0;
  for (const JacobianEntry& entry : entries) {
    // Of a distance of length L times a factor d the gradient is 2 d L and what Phi is small
    // against d L^2.
    const auto k = static_cast<std::size_t>(entry.row);
    const double size = std::pow(gradient[k] / 2, 2) / factor[k];
    const double acceleration =
        round * size * std::abs(entry.value) / mass[static_cast<std::size_t>(entry.col)];
    if (acceleration > most) {
      most = acceleration;
      worst = entry.col;
    }
  }
  if (most * walk <= kAllowed * length) return "";
  return fmt::format(
      "rounding of the penalty forces may drive {}, which is light, by {:.1e} m: try --scheme "
      "saddle-point",
      variable_name(model, worst), most * walk);
}

}  // namespace mbs
