// Predict, pass, project.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>

#include "penalty_form.hpp"
#include "saddle_form.hpp"

namespace mbs::csc_cholmod {

template <typename Form>
CholmodSimulation<Form>::CholmodSimulation(const Model& model, const StepSettings& settings,
                                           Method method)
    : Simulation(model, settings),
      settings_(settings),
      form_(model, settings, method),
      q_(form_.coordinates().all()),
      v_(model.variables()),
      a_(model.variables()),
      u_(form_.coordinates().all()),
      s_(form_.coordinates().all()),
      delta_(model.variables()),
      lambda_(model.constraints()),
      right_(form_.size()) {
  const std::vector<double>& constants = form_.coordinates().constants();
  std::copy(constants.begin(), constants.end(), q_.begin() + model.variables());
}

template <typename Form>
void CholmodSimulation<Form>::do_set_state(const State& state) {
  const std::vector<int>& place = form_.coordinates().number();
  for (std::size_t i = 0; i < place.size(); ++i) {
    q_[place[i]] = state.q[i];
    v_[place[i]] = state.v[i];
    a_[place[i]] = state.a[i];
  }
  for (std::size_t k = 0; k < lambda_.size(); ++k) {
    lambda_[form_.constraints().row(static_cast<int>(k))] = state.lambda[k];
  }
}

template <typename Form>
void CholmodSimulation<Form>::do_get_state(State& state) const {
  const std::vector<int>& place = form_.coordinates().number();
  for (std::size_t i = 0; i < place.size(); ++i) {
    state.q[i] = q_[place[i]];
    state.v[i] = v_[place[i]];
    state.a[i] = a_[place[i]];
  }
  for (std::size_t k = 0; k < lambda_.size(); ++k) {
    state.lambda[k] = lambda_[form_.constraints().row(static_cast<int>(k))];
  }
}

template <typename Form>
StepOutcome CholmodSimulation<Form>::do_step() {
  if (form_.has_drivers()) form_.drive(time(), q_.data(), u_.data(), s_.data());
  predict();
  phases_.enter(Phase::evaluation);
  form_.evaluate(q_.data());
  StepOutcome outcome{StepStatus::pass_limit, 0};
  while (outcome.status == StepStatus::pass_limit && outcome.passes < settings_.max_passes) {
    ++outcome.passes;
    form_.residual(q_.data(), u_.data(), s_.data(), lambda_.data(), right_.data());
    phases_.enter(Phase::assembly);
    form_.refresh_matrix();
    phases_.enter(Phase::factorization);
    if (!form_.factorize()) {
      phases_.enter(Phase::other);
      return {StepStatus::factorization_failed, outcome.passes};
    }
    phases_.enter(Phase::solve);
    form_.solve(right_.data(), delta_.data());  // Eq. (4), (12)
    phases_.enter(Phase::other);
    if (update()) outcome.status = StepStatus::converged;
    if (Form::kMultipliersFromSolution) form_.update_multipliers(lambda_.data());
    if (outcome.status == StepStatus::converged || outcome.passes == settings_.max_passes) {
      project();
      if (Form::kMultipliersFromSolution) break;
    }
    phases_.enter(Phase::evaluation);
    form_.evaluate(q_.data());  // serves the multipliers and the next pass
    if (!Form::kMultipliersFromSolution) form_.update_multipliers(lambda_.data());
  }
  phases_.enter(Phase::other);
  const double per_half = 2.0 / settings_.step;
  const double per_quarter = per_half * per_half;
  for (std::size_t i = 0; i < v_.size(); ++i) {
    v_[i] = per_half * u_[i];
    a_[i] = per_quarter * s_[i];
  }
  return outcome;
}

template <typename Form>
void CholmodSimulation<Form>::predict() {
  const double half = settings_.step / 2.0;
  const double quarter = half * half;
  double* __restrict q = q_.data();
  double* __restrict u = u_.data();
  double* __restrict s = s_.data();
  for (std::size_t i = 0; i < v_.size(); ++i) {
    const double old_u = half * v_[i];
    const double old_s = quarter * a_[i];
    const double next = q[i] + 2.0 * (old_u + old_s);
    const double difference = next - q[i];
    q[i] = next;
    u[i] = difference - old_u;                // Eq. (2)
    s[i] = difference - 2.0 * old_u - old_s;  // Eq. (2)
  }
}

template <typename Form>
bool CholmodSimulation<Form>::update() {
  const double tolerance = settings_.tolerance;
  const double* __restrict delta = delta_.data();
  double* __restrict q = q_.data();
  double* __restrict u = u_.data();
  double* __restrict s = s_.data();
  long long beyond = 0;
  for (std::size_t i = 0; i < v_.size(); ++i) {
    q[i] += delta[i];
    u[i] += delta[i];  // Eq. (2)
    s[i] += delta[i];  // Eq. (2)
    beyond += !(std::abs(delta[i]) <= tolerance);
  }
  return beyond == 0;
}

template <typename Form>
void CholmodSimulation<Form>::project() {
  if (settings_.projections == Projections::none) return;
  phases_.enter(Phase::projection);
  form_.take_first_rate(u_.data());
  correct(u_);
  if (settings_.projections != Projections::both) return;
  form_.take_second_rate(u_.data(), s_.data());
  correct(s_);
}

template <typename Form>
void CholmodSimulation<Form>::correct(std::vector<double>& x) {
  form_.projection(right_.data());
  phases_.enter(Phase::solve);
  form_.solve(right_.data(), delta_.data());  // Eq. (6), (13)
  phases_.enter(Phase::projection);
  for (std::size_t i = 0; i < v_.size(); ++i) x[i] += delta_[i];
}

template class CholmodSimulation<PenaltyForm>;
template class CholmodSimulation<SaddleForm>;

}  // namespace mbs::csc_cholmod
