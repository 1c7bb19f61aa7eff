// Set back, two half steps, compare.
#include "run/local_half_steps.hpp"

#include <limits>

#include "registry/factory.hpp"
#include "run/half_step_run.hpp"
#include "run/scene_distance.hpp"

namespace mbs {
namespace {

/// The same eps = 4 / (alpha dt^2).
StepSettings halved(StepSettings settings) {
  settings.step /= 2;
  settings.penalty *= 4;
  return settings;
}

}  // namespace

LocalHalfSteps::LocalHalfSteps(const Scene& scene, const Variant& variant,
                               const StepSettings& settings, double length)
    : scene_(scene),
      simulation_(create_simulation(variant, scene.model, halved(settings))),
      length_(length),
      factor_(richardson_factor(settings.scheme)) {}

double LocalHalfSteps::error(const State& before, const State& after) {
  simulation_->set_state(before);
  for (int i = 0; i < 2; ++i) {
    if (simulation_->step().status == StepStatus::factorization_failed) {
      return std::numeric_limits<double>::infinity();
    }
  }
  simulation_->get_state(state_);
  return factor_ * largest_distance(scene_, length_, after.q, state_.q);
}

}  // namespace mbs
