// The shortest table decides.
#include "run/driver_end.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "usage_error.hpp"

namespace mbs {

double driver_end(const Model& model) {
  double end = std::numeric_limits<double>::infinity();
  for (const DrivenPoint& point : model.driven_points()) {
    for (const TimeFunction& function : point.position) end = std::min(end, function.end());
  }
  for (const DrivenValue& value : model.driven_values()) end = std::min(end, value.value.end());
  return end;
}

void require_drivers_until(const Model& model, double end) {
  const double known = driver_end(model);
  if (end <= known + 1e-9 * std::abs(known)) return;
  throw UsageError(fmt::format(
      "--duration: the run would end at {:g} s, but a driver's table ends at {:g} s", end, known));
}

}  // namespace mbs
