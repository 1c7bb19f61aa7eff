// Right-hand sides and solutions of the saddle-point form.
#include "saddle_point_simulation.hpp"

#include <algorithm>
#include <functional>

namespace mbs::csc_mumps {

SaddlePointSimulation::SaddlePointSimulation(const Model& model, const StepSettings& settings)
    : CscMumpsSimulation(model, settings, model.variables() + model.constraints()),
      matrix_(model, assembly_, settings),
      solver_(matrix_.pattern(), matrix_.values(), matrix_.elimination_order(model)) {}

bool SaddlePointSimulation::solve_newton() {
  phases_.enter(Phase::evaluation);
  assembly_.balance(q_.data(), v_.data(), a_.data(), lambda_.data(), x_.data());
  std::copy(assembly_.phi().begin(), assembly_.phi().end(), lower());
  negate_lower();
  phases_.enter(Phase::assembly);
  if (!matrix_.evaluate()) return false;
  phases_.enter(Phase::factorization);     // with the solution in it: one call does both
  return solver_.factorize_and_solve(x_);  // Eq. (12)
}

void SaddlePointSimulation::update_multipliers() {
  const double* mu = lower();
  for (std::size_t i = 0; i < lambda_.size(); ++i) lambda_[i] += acceleration_factor_ * mu[i];
}

bool SaddlePointSimulation::project() {
  if (settings_.projections == Projections::none) return true;
  phases_.enter(Phase::projection);
  assembly_.multiply_inertia(v_.data(), x_.data());  // Eq. (13)
  assembly_.velocity_terms(q_.data(), lower());
  negate_lower();
  phases_.enter(Phase::solve);
  if (!solver_.solve(x_)) return false;
  phases_.enter(Phase::projection);
  std::copy_n(x_.begin(), variables_, v_.begin());
  if (settings_.projections == Projections::velocity) return true;
  assembly_.multiply_inertia(a_.data(), x_.data());  // Eq. (13)
  assembly_.acceleration_terms(q_.data(), v_.data(), lower());
  negate_lower();
  phases_.enter(Phase::solve);
  if (!solver_.solve(x_)) return false;
  std::copy_n(x_.begin(), variables_, a_.begin());
  return true;
}

void SaddlePointSimulation::negate_lower() {
  std::transform(lower(), lower() + lambda_.size(), lower(), std::negate<>());
}

}  // namespace mbs::csc_mumps
