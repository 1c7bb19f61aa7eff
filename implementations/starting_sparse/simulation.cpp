// Predictor, Newton passes, multiplier update and projections.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::starting_sparse {

std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return std::make_unique<StartingSparseSimulation>(model, settings);
}

StartingSparseSimulation::StartingSparseSimulation(const Model& model, const StepSettings& settings)
    : Simulation(model, settings),
      settings_(settings),
      assembly_(model, settings),
      solver_(assembly_.tangent()),
      q_(model.initial_position().begin(), model.initial_position().end()),
      v_(model.initial_velocity().begin(), model.initial_velocity().end()),
      a_(model.variables()),
      lambda_(model.constraints()),
      solution_(model.variables()) {
  q_.insert(q_.end(), assembly_.fixed_coordinates().begin(), assembly_.fixed_coordinates().end());
  v_.resize(q_.size());
}

void StartingSparseSimulation::do_set_state(const State& state) {
  std::copy(state.q.begin(), state.q.end(), q_.begin());
  std::copy(state.v.begin(), state.v.end(), v_.begin());
  a_ = state.a;
  lambda_ = state.lambda;
}

void StartingSparseSimulation::do_get_state(State& state) const {
  std::copy_n(q_.begin(), a_.size(), state.q.begin());
  std::copy_n(v_.begin(), a_.size(), state.v.begin());
  state.a = a_;
  state.lambda = lambda_;
}

StepOutcome StartingSparseSimulation::do_step() {
  phases_.enter(Phase::other);
  if (assembly_.is_driven()) assembly_.drive(time(), q_.data(), v_.data());
  predict();
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(q_.data());

  StepOutcome outcome{StepStatus::pass_limit, 0};
  while (outcome.status == StepStatus::pass_limit && outcome.passes < settings_.max_passes) {
    ++outcome.passes;
    if (!solve_newton()) {
      outcome.status = StepStatus::factorization_failed;
      break;
    }
    if (advance()) outcome.status = StepStatus::converged;
    const bool is_last =
        outcome.status == StepStatus::converged || outcome.passes == settings_.max_passes;
    if (is_last && !project()) {
      outcome.status = StepStatus::factorization_failed;
      break;
    }
    evaluate_and_raise_multipliers();
  }
  phases_.enter(Phase::other);
  return outcome;
}

void StartingSparseSimulation::predict() {
  const double step = settings_.step;
  for (std::size_t i = 0; i < a_.size(); ++i) {
    const double next = q_[i] + step * v_[i] + 0.5 * step * step * a_[i];
    const double difference = next - q_[i];
    a_[i] = 4.0 / (step * step) * difference - 4.0 / step * v_[i] - a_[i];  // Eq. (2)
    v_[i] = 2.0 / step * difference - v_[i];
    q_[i] = next;
  }
}

/// solution_ = Delta q of Eq. (4) at the evaluated q. False if the factorization failed.
bool StartingSparseSimulation::solve_newton() {
  phases_.enter(Phase::evaluation);
  assembly_.residual(q_.data(), v_.data(), a_.data(), lambda_.data(), solution_.data());
  if (!assembly_.is_finite()) return false;
  phases_.enter(Phase::assembly);
  assembly_.assemble();
  phases_.enter(Phase::factorization);  // with the solution in it: one call does both
  return solver_.factorize_and_solve(solution_.data());
}

/// Adds Delta q to q, v and a. True if it is within the tolerance everywhere; NaN is not.
bool StartingSparseSimulation::advance() {
  phases_.enter(Phase::other);
  const double to_velocity = 2.0 / settings_.step;
  const double to_acceleration = 4.0 / (settings_.step * settings_.step);
  int exceeding = 0;
  for (std::size_t i = 0; i < a_.size(); ++i) {
    const double difference = solution_[i];
    exceeding |= !(std::abs(difference) <= settings_.tolerance);
    q_[i] += difference;
    v_[i] += to_velocity * difference;  // Eq. (2)
    a_[i] += to_acceleration * difference;
  }
  return exceeding == 0;
}

void StartingSparseSimulation::evaluate_and_raise_multipliers() {
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(q_.data());
  phases_.enter(Phase::other);
  const std::span<const double> phi = assembly_.phi();
  for (std::size_t i = 0; i < lambda_.size(); ++i) lambda_[i] += settings_.penalty * phi[i];
}

/// Eq. (6) with the last factorization and its Phi_q, as far as the settings want it. False if a
/// solution failed.
bool StartingSparseSimulation::project() {
  if (settings_.projections == Projections::none) return true;
  phases_.enter(Phase::projection);
  assembly_.project_velocity(v_.data(), solution_.data());
  if (!change(v_)) return false;
  if (settings_.projections == Projections::velocity) return true;
  assembly_.project_acceleration(v_.data(), a_.data(), solution_.data());
  return change(a_);
}

bool StartingSparseSimulation::change(std::vector<double>& x) {
  phases_.enter(Phase::solve);
  if (!solver_.solve(solution_.data())) return false;
  phases_.enter(Phase::projection);
  for (std::size_t i = 0; i < solution_.size(); ++i) x[i] += solution_[i];
  return true;
}

}  // namespace mbs::starting_sparse
