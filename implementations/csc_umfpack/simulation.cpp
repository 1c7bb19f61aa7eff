// The step: prediction, Newton passes with multiplier updates, projections.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>

#include "penalty_system.hpp"
#include "saddle_point_system.hpp"

namespace mbs::csc_umfpack {

template <int D, template <int> class System>
CscUmfpack<D, System>::CscUmfpack(const Model& model, const StepSettings& settings, Tuning tuning)
    : Simulation(model, settings),
      settings_(settings),
      n_(model.variables()),
      m_(model.constraints()),
      quarter_(settings.step * settings.step / 4.0),
      points_(model),
      mass_(model),
      jacobian_(model, points_),
      forces_(model, points_, settings.step),
      system_(mass_, jacobian_, forces_, settings, tuning),
      drivers_(model, points_, jacobian_.layout()),
      force_(model.force().begin(), model.force().end()),
      q_(n_ + points_.fixed.size(), 0.0),
      v_(q_.size(), 0.0),
      a_(q_.size(), 0.0),
      lambda_(m_),
      Phi_(m_),
      rates_(m_),
      rhs_(system_.size()),
      delta_(system_.size()),
      change_(system_.size()) {
  std::ranges::copy(points_.fixed, q_.begin() + n_);
}

template <int D, template <int> class System>
void CscUmfpack<D, System>::do_set_state(const State& state) {
  std::ranges::copy(state.q, q_.begin());
  std::ranges::copy(state.v, v_.begin());
  std::ranges::copy(state.a, a_.begin());
  const auto& order = jacobian_.layout().order;
  for (int row = 0; row < m_; ++row) lambda_[row] = state.lambda[order[row]];
}

template <int D, template <int> class System>
void CscUmfpack<D, System>::do_get_state(State& state) const {
  std::copy_n(q_.begin(), n_, state.q.begin());
  std::copy_n(v_.begin(), n_, state.v.begin());
  std::copy_n(a_.begin(), n_, state.a.begin());
  const auto& order = jacobian_.layout().order;
  for (int row = 0; row < m_; ++row) state.lambda[order[row]] = lambda_[row];
}

template <int D, template <int> class System>
StepOutcome CscUmfpack<D, System>::do_step() {
  if (!drivers_.empty()) drive();
  predict();
  StepOutcome outcome{StepStatus::pass_limit, 0};
  for (bool last = false; !last;) {
    ++outcome.passes;
    evaluate_residual();
    phases_.enter(Phase::assembly);
    system_.assemble();
    phases_.enter(Phase::factorization);
    if (!system_.factorize()) {
      phases_.enter(Phase::other);
      return {StepStatus::factorization_failed, outcome.passes};
    }
    phases_.enter(Phase::solve);
    system_.solve(rhs_.data(), delta_.data());  // Eq. (4) or (12)
    phases_.enter(Phase::other);
    if (correct()) outcome.status = StepStatus::converged;
    last = outcome.status == StepStatus::converged || outcome.passes == settings_.max_passes;
    if (last) project();
    for (int i = 0; i < n_; ++i) q_[i] += delta_[i];
    if (!last || settings_.scheme == Scheme::penalty) evaluate_constraints();
    system_.update_multipliers(Phi_.data(), delta_.data(), lambda_.data());
  }
  phases_.enter(Phase::other);
  return outcome;
}

template <int D, template <int> class System>
void CscUmfpack<D, System>::drive() {
  drivers_.move(time(), q_.data(), v_.data(), a_.data());
  drivers_.set_values(time(), jacobian_);
  drivers_.set_force(a_.data(), force_.data());
}

template <int D, template <int> class System>
void CscUmfpack<D, System>::predict() {
  const double h = settings_.step;
  double *q = q_.data(), *v = v_.data(), *a = a_.data();
  for (int i = 0; i < n_; ++i) {
    const double q_new = q[i] + (h * v[i] + (h * h / 2.0) * a[i]);
    const double difference = q_new - q[i];
    a[i] = (4.0 / (h * h)) * difference - (4.0 / h) * v[i] - a[i];  // Eq. (2)
    v[i] = (2.0 / h) * difference - v[i];                           // Eq. (2)
    q[i] = q_new;
  }
  evaluate_constraints();
}

template <int D, template <int> class System>
void CscUmfpack<D, System>::evaluate_residual() {
  mass_.residual(a_.data(), force_.data(), quarter_, rhs_.data());
  forces_.evaluate(q_.data(), v_.data(), rhs_.data());
  system_.add_constraints(lambda_.data(), Phi_.data(), rhs_.data());
}

template <int D, template <int> class System>
bool CscUmfpack<D, System>::correct() {
  const double to_v = 2.0 / settings_.step, to_a = to_v * to_v;
  const double tolerance = settings_.tolerance;
  double *v = v_.data(), *a = a_.data();
  const double* delta_q = delta_.data();
  int outside = 0;
  for (int i = 0; i < n_; ++i) {
    outside += !(std::abs(delta_q[i]) <= tolerance);  // a NaN is outside
    v[i] += to_v * delta_q[i];                        // Eq. (2)
    a[i] += to_a * delta_q[i];                        // Eq. (2)
  }
  return outside == 0;
}

template <int D, template <int> class System>
void CscUmfpack<D, System>::project() {
  if (settings_.projections == Projections::none) return;
  phases_.enter(Phase::projection);
  jacobian_.rates(q_.data(), v_.data(), rates_.data());
  drivers_.subtract_rates(rates_.data());
  add_projection(v_);
  if (settings_.projections == Projections::velocity) return;
  jacobian_.second_rates(q_.data(), v_.data(), a_.data(), rates_.data());
  drivers_.subtract_second_rates(rates_.data());
  add_projection(a_);
}

template <int D, template <int> class System>
void CscUmfpack<D, System>::add_projection(std::vector<double>& x) {
  system_.project(rates_.data(), rhs_.data());
  phases_.enter(Phase::solve);
  system_.solve(rhs_.data(), change_.data());  // Eq. (6) or (13)
  phases_.enter(Phase::projection);
  for (int i = 0; i < n_; ++i) x[i] += change_[i];
}

template <int D, template <int> class System>
void CscUmfpack<D, System>::evaluate_constraints() {
  phases_.enter(Phase::evaluation);
  jacobian_.evaluate(q_.data(), Phi_.data());
}

template class CscUmfpack<2, PenaltySystem>;
template class CscUmfpack<3, PenaltySystem>;
template class CscUmfpack<2, SaddlePointSystem>;
template class CscUmfpack<3, SaddlePointSystem>;

}  // namespace mbs::csc_umfpack
