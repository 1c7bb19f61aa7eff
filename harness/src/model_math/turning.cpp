// Speed and free fall of every point.
#include "model_math/turning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model_math/connected_parts.hpp"
#include "model_math/kinematics.hpp"
#include "model_math/shortest_lengths.hpp"

namespace mbs {
namespace {

/// Of the points that it was shown.
struct Fastest {
  Turning turning;
  double shortest = std::numeric_limits<double>::infinity();

  void see(double rate, double length) {
    shortest = std::min(shortest, length);
    if (rate > turning.rate) turning = {rate, length};
  }
  [[nodiscard]] bool has_seen() const { return std::isfinite(shortest); }
  [[nodiscard]] Turning found() const {
    return turning.rate == 0.0 && has_seen() ? Turning{0.0, shortest} : turning;
  }
};

/// Calls `see` with each free point that has a length, its rate and that.
template <class See>
void for_each_turning(const Model& model, See see) {
  const auto n = static_cast<std::size_t>(model.variables());
  const std::vector<double> mass = mass_diagonal(model);
  std::vector<double> force(n);
  applied_force(model, 0.0, model.initial_position(), model.initial_velocity(), force);
  const std::vector<double> length = shortest_lengths(model);
  for (std::size_t k = 0; k < length.size(); ++k) {
    const Point& point = model.points()[k];
    if (point.is_fixed() || length[k] == 0.0) continue;
    double speed = 0.0, acceleration = 0.0;
    for (int axis = 0; axis < model.dimension(); ++axis) {
      const auto i = static_cast<std::size_t>(point.offset + axis);
      speed = std::hypot(speed, model.initial_velocity()[i]);
      acceleration = std::hypot(acceleration, force[i] / mass[i]);
    }
    see(point, std::max(speed / length[k], std::sqrt(2.0 * acceleration / length[k])), length[k]);
  }
}

}  // namespace

Turning fastest_turning(const Model& model) {
  Fastest all;
  for_each_turning(model, [&](const Point&, double rate, double length) { all.see(rate, length); });
  return all.found();
}

std::vector<double> part_lengths(const Model& model) {
  const auto points = model.points();
  ConnectedParts parts(model);
  std::vector<Fastest> fastest(points.size() + 1);
  const auto part_of = [&](const Point& point) -> Fastest& {
    return fastest[static_cast<std::size_t>(parts.part_of(point.offset))];
  };
  for_each_turning(model, [&](const Point& point, double rate, double length) {
    part_of(point).see(rate, length);
  });
  std::vector<double> result(points.size(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (points[k].is_fixed()) continue;
    const Fastest& part = part_of(points[k]);
    if (part.has_seen()) result[k] = part.found().length;
  }
  return result;
}

}  // namespace mbs
