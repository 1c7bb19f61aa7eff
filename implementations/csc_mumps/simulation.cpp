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
    return std::make_unique<SaddlePointSimulation>(model, settings);
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
      free_part_(model.constraints(), 0.0),
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
  int passes = 0;
  Pass pass = Pass::unconverged;
  while (pass == Pass::unconverged && passes < settings_.max_passes) {
    pass = newton_pass();
    ++passes;
  }
  const bool solved = pass != Pass::failed && project();
  phases_.enter(Phase::other);
  if (!solved) return {StepStatus::factorization_failed, passes};
  return {pass == Pass::converged ? StepStatus::converged : StepStatus::pass_limit, passes};
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

CscMumpsSimulation::Pass CscMumpsSimulation::newton_pass() {
  if (!solve_newton()) return Pass::failed;
  phases_.enter(Phase::other);
  const bool converged = correct();
  phases_.enter(Phase::evaluation);
  assembly_.evaluate_constraints(q_.data());
  phases_.enter(Phase::other);
  update_multipliers();
  return converged ? Pass::converged : Pass::unconverged;
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
  assembly_.velocity_terms(q_.data(), free_part_.data());
  if (!change(v_)) return false;
  if (settings_.projections == Projections::velocity) return true;
  assembly_.acceleration_terms(q_.data(), v_.data(), free_part_.data());
  return change(a_);
}

bool CscMumpsSimulation::change(std::vector<double>& rates) {
  if (!solve_projection(rates.data())) return false;
  phases_.enter(Phase::projection);
  for (int i = 0; i < variables_; ++i) rates[i] += x_[i];
  return true;
}

}  // namespace mbs::csc_mumps
