// Makes the steps.
#include "describe/passes.hpp"

#include <algorithm>
#include <exception>

#include "registry/factory.hpp"
#include "run/settings.hpp"
#include "run/stretch.hpp"

namespace mbs {

std::optional<double> count_passes(const Scene& scene, StepSettings settings,
                                   const Variant& variant, double flops, double smallest) {
  constexpr double kMostOperations = 1e9, kFewest = 4;  // of all factorizations, about; steps
  const double affordable = kMostOperations / std::max(flops, 1.0);
  if (affordable < kFewest) return std::nullopt;
  const int wanted =
      static_cast<int>(std::min<double>(affordable, most_steps(scene.model.variables())));
  int steps = 0, passes = 0;
  try {
    settings = chosen(scene.model, settings, smallest);
    const Stretch stretch =
        make_stretch(scene, settings.step, wanted, std::nullopt, settings.scheme);
    const auto simulation = create_simulation(variant, scene.model, settings);
    simulation->set_state(stretch.initial);
    while (steps < stretch.steps) {
      const StepOutcome outcome = simulation->step();
      if (outcome.status == StepStatus::factorization_failed) break;
      passes += outcome.passes;
      ++steps;
    }
  } catch (const std::exception&) {
    // No factor, drivers too fast for the step, or a lost motion: those who run it are told.
  }
  if (steps == 0) return std::nullopt;
  return static_cast<double>(passes) / steps;
}

}  // namespace mbs
