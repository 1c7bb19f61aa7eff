// Predict, Newton passes with multiplier updates, projections.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::starting_dense {

DenseSimulation::DenseSimulation(const Model& model, const StepSettings& settings)
    : Simulation(model, settings),
      settings_(settings),
      n_(model.variables()),
      assembly_(model, settings),
      solver_(n_),
      q_(assembly_.extended_position()),
      v_(q_.size()),
      a_(n_),
      lambda_(model.constraints()),
      multipliers_(model.constraints()),
      solution_(n_) {
  std::copy(model.initial_velocity().begin(), model.initial_velocity().end(), v_.begin());
}

void DenseSimulation::do_set_state(const State& state) {
  std::copy(state.q.begin(), state.q.end(), q_.begin());
  std::copy(state.v.begin(), state.v.end(), v_.begin());
  a_ = state.a;
  lambda_ = state.lambda;
}

void DenseSimulation::do_get_state(State& state) const {
  std::copy_n(q_.begin(), n_, state.q.begin());
  std::copy_n(v_.begin(), n_, state.v.begin());
  state.a = a_;
  state.lambda = lambda_;
}

StepOutcome DenseSimulation::do_step() {
  StepOutcome outcome{StepStatus::pass_limit, 0};
  phases_.enter(Phase::other);
  predict();
  phases_.enter(Phase::evaluation);
  if (assembly_.driven()) assembly_.drive(time(), q_, v_);
  assembly_.evaluate(q_);
  for (bool last = false; !last;) {
    ++outcome.passes;
    bool converged = false;
    if (!pass(converged)) {
      outcome.status = StepStatus::factorization_failed;
      phases_.enter(Phase::other);
      return outcome;
    }
    if (converged) outcome.status = StepStatus::converged;
    last = converged || outcome.passes == settings_.max_passes;
    if (last) project();  // before Phi_q is evaluated anew
    update_multipliers();
  }
  phases_.enter(Phase::other);
  return outcome;
}

void DenseSimulation::predict() {
  const double h = settings_.step;
  for (int i = 0; i < n_; ++i) {
    const double q = q_[i];
    q_[i] = q + (h * v_[i] + 0.5 * h * h * a_[i]);
    const double moved = q_[i] - q;
    a_[i] = 4.0 / (h * h) * moved - 4.0 / h * v_[i] - a_[i];  // Eq. (2)
    v_[i] = 2.0 / h * moved - v_[i];                          // Eq. (2)
  }
}

bool DenseSimulation::pass(bool& converged) {
  const double quarter = 0.25 * settings_.step * settings_.step;
  phases_.enter(Phase::evaluation);
  const Vector& phi = assembly_.phi();
  for (std::size_t i = 0; i < lambda_.size(); ++i) {
    multipliers_[i] = lambda_[i] + settings_.penalty * phi[i];
  }
  assembly_.evaluate_forces(q_, v_);
  assembly_.residual(a_, multipliers_, solution_);
  for (double& entry : solution_) entry *= -quarter;  // Eq. (3), -f
  phases_.enter(Phase::assembly);
  assembly_.tangent(solver_.matrix());  // Eq. (5)
  phases_.enter(Phase::factorization);
  if (!solver_.factorize()) return false;
  phases_.enter(Phase::solve);
  solver_.solve(solution_);  // Eq. (4)
  phases_.enter(Phase::other);
  apply_increment(converged);
  return true;
}

void DenseSimulation::apply_increment(bool& converged) {
  const double h = settings_.step;
  converged = true;
  for (int i = 0; i < n_; ++i) {
    const double increment = solution_[i];
    q_[i] += increment;
    v_[i] += 2.0 / h * increment;        // Eq. (2)
    a_[i] += 4.0 / (h * h) * increment;  // Eq. (2)
    // The negation: a NaN has not converged.
    if (!(std::abs(increment) <= settings_.tolerance)) converged = false;
  }
}

void DenseSimulation::update_multipliers() {
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(q_);
  phases_.enter(Phase::other);
  const Vector& phi = assembly_.phi();
  for (std::size_t i = 0; i < lambda_.size(); ++i) {
    lambda_[i] += settings_.penalty * phi[i];  // Eq. (1)
  }
}

void DenseSimulation::project() {
  if (settings_.projections == Projections::none) return;
  phases_.enter(Phase::projection);
  assembly_.velocity_right(v_, solution_);  // Eq. (6), velocities
  phases_.enter(Phase::solve);
  solver_.solve(solution_);
  for (int i = 0; i < n_; ++i) v_[i] += solution_[i];
  if (settings_.projections == Projections::velocity) return;
  phases_.enter(Phase::projection);
  assembly_.acceleration_right(v_, a_, solution_);  // Eq. (6), accelerations
  phases_.enter(Phase::solve);
  solver_.solve(solution_);
  for (int i = 0; i < n_; ++i) a_[i] += solution_[i];
}

}  // namespace mbs::starting_dense
