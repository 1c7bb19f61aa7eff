// Speed and free fall of every point.
#include "model_math/turning.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "model_math/kinematics.hpp"
#include "model_math/shortest_lengths.hpp"

namespace mbs {

Turning fastest_turning(const Model& model) {
  const auto n = static_cast<std::size_t>(model.variables());
  const std::vector<double> mass = mass_diagonal(model);
  std::vector<double> force(n);
  applied_force(model, 0.0, model.initial_position(), model.initial_velocity(), force);
  const std::vector<double> length = shortest_lengths(model);
  Turning result;
  for (std::size_t k = 0; k < length.size(); ++k) {
    const Point& point = model.points()[k];
    if (point.is_fixed() || length[k] == 0.0) continue;
    double speed = 0.0, acceleration = 0.0;
    for (int axis = 0; axis < model.dimension(); ++axis) {
      const auto i = static_cast<std::size_t>(point.offset + axis);
      speed = std::hypot(speed, model.initial_velocity()[i]);
      acceleration = std::hypot(acceleration, force[i] / mass[i]);
    }
    const double rate = std::max(speed / length[k], std::sqrt(2.0 * acceleration / length[k]));
    if (rate > result.rate) result = {rate, length[k]};
  }
  return result;
}

}  // namespace mbs
