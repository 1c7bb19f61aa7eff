// Set back, two half steps, compare.
#include "run/local_half_steps.hpp"

#include <limits>

#include "run/half_step_run.hpp"

namespace mbs {
namespace {

/// The same eps = 4 / (alpha dt^2).
StepSettings halved(StepSettings settings) {
  settings.step /= 2;
  settings.penalty *= 4;
  return settings;
}

}  // namespace

LocalHalfSteps::LocalHalfSteps(const StepAgain::Create& create, const StepSettings& settings)
    : simulation_(create(halved(settings))),
      factor_(richardson_factor(settings.scheme)) {}

const std::vector<double>& LocalHalfSteps::error(const State& before, const State& after) {
  simulation_->set_state(before);
  double factor = factor_;
  for (int i = 0; i < 2; ++i) {
    if (simulation_->step().status == StepStatus::factorization_failed)
      factor = std::numeric_limits<double>::quiet_NaN();
  }
  simulation_->get_state(state_);
  error_.resize(state_.q.size());
  for (std::size_t i = 0; i < error_.size(); ++i) error_[i] = factor * (after.q[i] - state_.q[i]);
  return error_;
}

}  // namespace mbs
