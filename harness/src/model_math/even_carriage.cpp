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
  const auto first_linear = model.constraints() - static_cast<int>(model.linear_constraints().size());
  std::erase_if(at_rest.driven_values,
                [&](const DrivenValue& driven) { return driven.constraint >= first_linear; });
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
  const auto values = KnownMotion(model, 0.0).values();
  auto value = values.end() - static_cast<std::ptrdiff_t>(model.linear_constraints().size());
  for (const LinearConstraint& c : model.linear_constraints()) {  // it holds in that frame too
    double rate = -value->rate, size = std::abs(rate);
    for (const auto& term : c.terms) {
      const double part =
          term.coefficient * result.velocity_[static_cast<std::size_t>(term.coordinate)];
      rate += part;
      size += std::abs(part);
    }
    if (std::abs(rate) > 1e-12 * size) return std::nullopt;
    ++value;
  }
  constexpr double kLongest = 1000.0;  // s
  for (double t = 0.01; t < kLongest; t *= 1.618) {
    if (!result.holds(model, t)) return std::nullopt;
  }
  return result;
}

bool EvenCarriage::holds(const Model& model, double t) const {
  const auto is_even = [t](const TimeFunction& function, double rate) {
    if (t > function.end()) return true;
    constexpr double kSmall = 1e-12;
    const double start = function.at(0.0).value, way = rate * t;
    const auto now = function.at(t);
    return now.acceleration == 0.0 &&
           std::abs(now.value - start - way) <= kSmall * (std::abs(start) + std::abs(way));
  };
  for (const DrivenPoint& driven : model.driven_points()) {
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(model.dimension()); ++axis) {
      if (!is_even(driven.position[axis], carried_[axis])) return false;
    }
  }
  for (const DrivenValue& driven : model.driven_values()) {
    if (!is_even(driven.value, driven.value.at(0.0).rate)) return false;
  }
  return true;
}

}  // namespace mbs
