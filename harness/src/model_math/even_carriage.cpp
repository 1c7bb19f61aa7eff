// Fixed points, absolute coordinates and drivers, one after the other.
#include "model_math/even_carriage.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model_math/kinematics.hpp"
#include "model_math/known_motion.hpp"

namespace mbs {

std::optional<EvenCarriage> EvenCarriage::of(const Model& model) {
  if (model.driven_points().empty()) return std::nullopt;
  ModelData at_rest = model.data();
  at_rest.driven_points.clear();
  at_rest.driven_mass.clear();
  if (!is_conservative(Model(std::move(at_rest)))) return std::nullopt;
  EvenCarriage result;
  const auto points = model.points();
  result.carried_ = KnownMotion(model, 0.0).velocity(model.driven_points().front().point);
  result.velocity_.assign(static_cast<std::size_t>(model.variables()), 0.0);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (points[p].is_vector) continue;
    const bool is_driven = std::ranges::find(model.driven_points(), static_cast<int>(p),
                                             &DrivenPoint::point) != model.driven_points().end();
    if (points[p].is_fixed() && !is_driven) return std::nullopt;
    if (points[p].is_fixed()) continue;
    for (int axis = 0; axis < model.dimension(); ++axis) {
      result.velocity_[static_cast<std::size_t>(points[p].offset + axis)] =
          result.carried_[static_cast<std::size_t>(axis)];
    }
  }
  for (const LinearConstraint& c : model.linear_constraints()) {  // between coordinates alone
    double rate = 0.0, size = 0.0;
    for (const auto& term : c.terms) {
      const double part =
          term.coefficient * result.velocity_[static_cast<std::size_t>(term.coordinate)];
      rate += part;
      size += std::abs(part);
    }
    if (std::abs(rate) > 1e-12 * size) return std::nullopt;
  }
  constexpr double kLongest = 1000.0;  // s
  for (double t = 0.01; t < kLongest; t *= 1.618) {
    if (!result.holds(model, t)) return std::nullopt;
  }
  return result;
}

bool EvenCarriage::holds(const Model& model, double t) const {
  constexpr double kSmall = 1e-12;
  for (const DrivenPoint& driven : model.driven_points()) {
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(model.dimension()); ++axis) {
      const TimeFunction& position = driven.position[axis];
      if (t > position.end()) continue;
      const double start = position.at(0.0).value, way = carried_[axis] * t;
      const auto now = position.at(t);
      if (!(std::abs(now.value - start - way) <= kSmall * (std::abs(start) + std::abs(way)))) {
        return false;
      }
      if (now.acceleration != 0.0) return false;
    }
  }
  return true;
}

}  // namespace mbs
