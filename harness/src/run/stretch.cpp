// Places a stretch on the motion.
#include "run/stretch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exact/four_bar_exact.hpp"
#include "run/driver_end.hpp"
#include "run/initial_state.hpp"
#include "usage_error.hpp"

namespace mbs {

int most_steps(int variables) {
  constexpr int kMost = 800, kLeast = 40, kFull = 400;
  if (variables <= kFull) return kMost;
  const double steps = static_cast<double>(kMost) * kFull / variables;
  return std::max(kLeast, 10 * static_cast<int>(std::lround(steps / 10)));
}

Stretch make_stretch(const Scene& scene, double step, int steps, std::optional<double> start,
                     Scheme scheme) {
  if (!scene.four_bar_loops) {
    if (start && *start != 0.0) {
      throw UsageError(
          fmt::format("--start needs an exact solution: scene '{}' starts at 0", scene.name));
    }
    // Steps, but for rounding; infinite without tables.
    const double known = driver_end(scene.model) / step * (1 + 1e-9);
    if (known < 1.0) {
      throw UsageError(fmt::format("--step is {:g} s: a driver's table ends at {:g} s", step,
                                   driver_end(scene.model)));
    }
    if (known < steps) steps = static_cast<int>(known);
    require_drivers(scene, step, steps);
    return {0.0, steps, initial_state(scene.model)};
  }
  if (start && !(*start >= 0.0 && std::isfinite(*start))) {
    throw UsageError(fmt::format("--start is {:g} s: it must be at least 0", *start));
  }
  const FourBarExact exact(*scene.four_bar_loops);
  const double singular = exact.first_singular_time();
  double begin = singular - steps / 2 * step;
  if (*scene.four_bar_loops > kMostLoopsToCross || scheme == Scheme::multistep6) {
    const double room = std::floor((singular - kClearance) / step);
    if (!start) steps = static_cast<int>(std::clamp<double>(room, 1, steps));
    begin = singular - kClearance - steps * step;
  }
  Stretch stretch{start.value_or(std::max(0.0, begin)), steps, {}};
  const auto n = static_cast<std::size_t>(scene.model.variables());
  std::vector<double> q(n), v(n), a(n);
  exact.state(stretch.start, q, v, a);
  stretch.initial = consistent_state(scene.model, q, v, stretch.start);
  return stretch;
}

}  // namespace mbs
