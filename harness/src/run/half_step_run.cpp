// Positions at the steps that both simulations share.
#include "run/half_step_run.hpp"

#include <cmath>
#include <limits>

#include "run/scene_distance.hpp"

namespace mbs {

double richardson_factor(Scheme scheme) {
  const bool is_sixth = scheme == Scheme::rattle6 || scheme == Scheme::multistep6;
  const int order = scheme == Scheme::rattle4 ? 4 : is_sixth ? 6 : 2;
  return 1.0 / (1.0 - std::ldexp(1.0, -order));
}

HalfStepRun::HalfStepRun(const Scene& scene, const StepAgain::Create& create,
                         const StepSettings& half, const State& initial, double length)
    : scene_(scene),
      simulation_(create(half)),
      state_(initial),
      length_(length),
      factor_(richardson_factor(half.scheme)) {
  simulation_->set_state(initial);
}

void HalfStepRun::advance() {
  for (int i = 0; i < 2; ++i) {
    if (simulation_->step().status == StepStatus::factorization_failed) {
      error_ = std::numeric_limits<double>::infinity();
    }
  }
}

void HalfStepRun::compare(const State& whole) {
  simulation_->get_state(state_);
  const double error = factor_ * largest_distance(scene_, length_, whole.q, state_.q);
  // Not std::max, which would drop a NaN.
  if (!(error <= error_)) {
    error_ = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
  }
}

}  // namespace mbs
