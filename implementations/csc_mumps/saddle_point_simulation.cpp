// Right-hand sides and solutions of the saddle-point form.
#include "saddle_point_simulation.hpp"

#include <algorithm>
#include <functional>

namespace mbs::csc_mumps {

SaddlePointSimulation::SaddlePointSimulation(const Model& model, const StepSettings& settings,
                                             Tuning tuning)
    : CscMumpsSimulation(model, settings, model.variables() + model.constraints()),
      matrix_(model, assembly_, settings),
      solver_(matrix_.pattern(), matrix_.values(), matrix_.elimination_order(model, tuning)) {}

bool SaddlePointSimulation::solve_newton() {
  phases_.enter(Phase::evaluation);
  assembly_.balance(q_.data(), v_.data(), a_.data(), lambda_.data(), x_.data());
  std::transform(assembly_.phi().begin(), assembly_.phi().end(), lower(), std::negate<>());
  phases_.enter(Phase::assembly);
  if (!matrix_.evaluate()) return false;
  phases_.enter(Phase::factorization);     // with the solution in it: one call does both
  return solver_.factorize_and_solve(x_);  // Eq. (12)
}

void SaddlePointSimulation::take_multipliers() {
  const double* mu = lower();
  for (std::size_t i = 0; i < lambda_.size(); ++i) lambda_[i] += acceleration_factor_ * mu[i];
}

bool SaddlePointSimulation::solve_projection() {
  std::fill_n(x_.begin(), variables_, 0.0);
  std::transform(rates_.begin(), rates_.end(), lower(), std::negate<>());
  phases_.enter(Phase::solve);
  return solver_.solve(x_);  // Eq. (13)
}

}  // namespace mbs::csc_mumps
