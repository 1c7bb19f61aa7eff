// Prediction, Newton passes, correction, projections; which form they serve is chosen here, once.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>

#include "penalty_simulation.hpp"
#include "saddle_point_simulation.hpp"

namespace mbs::csc_mumps {

std::unique_ptr<Simulation> make_simulation(const Model& model, const StepSettings& settings,
                                            Tuning tuning) {
  if (settings.scheme == Scheme::saddle_point) {
    return std::make_unique<SaddlePointSimulation>(model, settings, tuning);
  }
  return std::make_unique<PenaltySimulation>(model, settings, tuning);
}

CscMumpsSimulation::CscMumpsSimulation(const Model& model, const StepSettings& settings,
                                       int unknowns)
    : Simulation(model, settings),
      variables_(model.variables()),
      settings_(settings),
      velocity_factor_(2.0 / settings.step),
      acceleration_factor_(4.0 / (settings.step * settings.step)),
      assembly_(model, settings.step),
      a_(variables_, 0.0),
      lambda_(model.constraints(), 0.0),
      rates_(model.constraints(), 0.0),
      x_(unknowns, 0.0) {
  const std::span<const double> fixed = assembly_.fixed_coordinates();
  q_.assign(model.initial_position().begin(), model.initial_position().end());
  q_.insert(q_.end(), fixed.begin(), fixed.end());
  v_.assign(model.initial_velocity().begin(), model.initial_velocity().end());
  v_.resize(q_.size(), 0.0);
}

void CscMumpsSimulation::do_set_state(const State& state) {
  std::copy(state.q.begin(), state.q.end(), q_.begin());
  std::copy(state.v.begin(), state.v.end(), v_.begin());
  std::copy(state.a.begin(), state.a.end(), a_.begin());
  std::copy(state.lambda.begin(), state.lambda.end(), lambda_.begin());
}

void CscMumpsSimulation::do_get_state(State& state) const {
  std::copy_n(q_.begin(), variables_, state.q.begin());
  std::copy_n(v_.begin(), variables_, state.v.begin());
  std::copy(a_.begin(), a_.end(), state.a.begin());
  std::copy(lambda_.begin(), lambda_.end(), state.lambda.begin());
}

StepOutcome CscMumpsSimulation::do_step() {
  phases_.enter(Phase::other);
  if (assembly_.is_driven()) assembly_.drive(time(), q_.data(), v_.data());
  predict();
  StepOutcome outcome{StepStatus::pass_limit};
  while (outcome.status == StepStatus::pass_limit && outcome.passes < settings_.max_passes) {
    ++outcome.passes;
    newton_pass(outcome);
  }
  phases_.enter(Phase::other);
  return outcome;
}

void CscMumpsSimulation::predict() {
  const double step = settings_.step;
  for (int i = 0; i < variables_; ++i) {
    const double start = q_[i];
    q_[i] = start + step * (v_[i] + 0.5 * step * a_[i]);
    const double moved = q_[i] - start;
    a_[i] = acceleration_factor_ * moved - 2.0 * velocity_factor_ * v_[i] - a_[i];  // Eq. (2)
    v_[i] = velocity_factor_ * moved - v_[i];                                       // Eq. (2)
  }
  phases_.enter(Phase::evaluation);
  assembly_.evaluate_constraints(q_.data());
}

/// Of the step's last pass with the projections, which come before the constraints are evaluated
/// anew.
void CscMumpsSimulation::newton_pass(StepOutcome& outcome) {
  outcome.status = StepStatus::factorization_failed;
  if (!solve_newton()) return;
  phases_.enter(Phase::other);
  const bool converged = correct();
  take_multipliers();
  const bool is_last = converged || outcome.passes == settings_.max_passes;
  if (is_last && !project()) return;
  if (!is_last || settings_.scheme == Scheme::penalty) {
    phases_.enter(Phase::evaluation);
    assembly_.evaluate_constraints(q_.data());
    phases_.enter(Phase::other);
  }
  update_multipliers();
  outcome.status = converged ? StepStatus::converged : StepStatus::pass_limit;
}

/// Applies Delta q, the beginning of x_. True if all of it is within the tolerance; a NaN is not.
bool CscMumpsSimulation::correct() {
  int outside = 0;
  for (int i = 0; i < variables_; ++i) {
    const double change = x_[i];
    outside += !(std::abs(change) <= settings_.tolerance);
    q_[i] += change;
    v_[i] += velocity_factor_ * change;      // Eq. (2)
    a_[i] += acceleration_factor_ * change;  // Eq. (2)
  }
  return outside == 0;
}

/// Corrects v_, then a_, as far as asked for. False if the solver gave up.
bool CscMumpsSimulation::project() {
  if (settings_.projections == Projections::none) return true;
  phases_.enter(Phase::projection);
  assembly_.first_derivative(v_.data(), rates_.data());
  if (!change(v_)) return false;
  if (settings_.projections == Projections::velocity) return true;
  assembly_.second_derivative(v_.data(), a_.data(), rates_.data());
  return change(a_);
}

bool CscMumpsSimulation::change(std::vector<double>& x) {
  if (!solve_projection()) return false;
  phases_.enter(Phase::projection);
  for (int i = 0; i < variables_; ++i) x[i] += x_[i];
  return true;
}

}  // namespace mbs::csc_mumps
