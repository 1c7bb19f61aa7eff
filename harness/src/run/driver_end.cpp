// The shortest table decides; ranges are looked at step by step.
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
  for (const ForceLaw& law : model.force_laws()) end = std::min(end, law.law.factor.end());
  for (const TorqueLaw& law : model.torque_laws()) end = std::min(end, law.law.factor.end());
  return end;
}

namespace {

void require_driver(const std::string& where, const Driver& driver, double step, long steps) {
  const auto fail = [&](const std::string& what) {
    throw UsageError(fmt::format("{}: {}: {}", where, driver.path, what));
  };
  const std::string of = driver.name.empty() ? "" : " of " + driver.name;
  if (step > driver.longest_step * (1 + 1e-9)) {
    fail(fmt::format("found a driver{} too fast for --step {:g} s, allowed is up to {:g} s, {}", of,
                     step, driver.longest_step, driver.resolution));
  }
  const bool is_bounded = std::isfinite(driver.least) || std::isfinite(driver.largest_change);
  double before = driver.value.at(0.0).value;
  for (long i = 0; is_bounded && i <= steps; ++i) {
    const double t = static_cast<double>(i) * step, value = driver.value.at(t).value;
    if (!(value >= driver.least && value <= driver.most)) {
      fail(
          fmt::format("found a value{} of {:.4g} at t = {:g} s, allowed is {} until the end of the "
                      "run at {:g} s",
                      of, value, t, driver.range, static_cast<double>(steps) * step));
    }
    if (!(std::abs(value - before) <= driver.largest_change)) {
      fail(fmt::format(
          "found a value{} that changes by {:.4g} rad in the step of {:g} s to t = {:g} "
          "s, allowed is {:.4g} rad a step",
          of, std::abs(value - before), step, t, driver.largest_change));
    }
    before = value;
  }
}

}  // namespace

void require_drivers(const Scene& scene, double step, long steps) {
  const double known = driver_end(scene.model);
  const double end = static_cast<double>(steps) * step;
  if (end > known + 1e-9 * std::abs(known)) {
    throw UsageError(
        fmt::format("{}: the run would end at {:g} s, but a driver's table ends at {:g} s",
                    scene.name, end, known));
  }
  for (const Driver& driver : scene.elements.drivers) {
    require_driver(scene.name, driver, step, steps);
  }
}

}  // namespace mbs
