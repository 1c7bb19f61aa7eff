#include "simulation.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::hybrid_dense {

template <int D, class System>
HybridSimulation<D, System>::HybridSimulation(const Model& model, const StepSettings& settings)
    : Simulation(model, settings),
      model_(model),
      settings_(settings),
      driven_(std::ranges::any_of(model.force_laws(),
                                  [](const auto& law) { return !law.law.factor.is_constant(); }) ||
              std::ranges::any_of(model.torque_laws(),
                                  [](const auto& law) { return !law.law.factor.is_constant(); }) ||
              !model.driven_points().empty() || !model.driven_values().empty()) {
  for (std::size_t p = 0; p < model.points().size(); ++p) {
    if (model.points()[p].is_fixed()) {
      std::copy_n(model.points()[p].position.begin(), D, q_.data() + slots_.of[p]);
    }
  }
  std::ranges::copy(model.force(), Q_.data());
  constraints_.write_constants(Phi_q_.data());
}

template <int D, class System>
StepOutcome HybridSimulation<D, System>::do_step() {
  StepOutcome outcome{StepStatus::pass_limit};  // unless a pass converges
  predict();
  evaluate_constraints();
  for (bool last = false; !last;) {
    ++outcome.passes;
    evaluate_residual();
    phases_.enter(Phase::assembly);
    system_.assemble(Phi_q_.data());
    phases_.enter(Phase::factorization);
    if (!system_.factorize()) return {StepStatus::factorization_failed, outcome.passes};
    phases_.enter(Phase::solve);
    if constexpr (System::kSaddle) {  // Eq. (12)
      for (long k = 0; k < m_; ++k) y_[k] = -Phi_[k];
      system_.solve(Delta_q_.data(), y_.data());
    } else {
      system_.solve(Delta_q_.data());  // Eq. (4)
    }
    if (correct()) outcome.status = StepStatus::converged;
    if constexpr (System::kSaddle) {
      for (long k = 0; k < m_; ++k) lambda_[k] += 4 / (dt_ * dt_) * y_[k];
    }
    last = outcome.status == StepStatus::converged || outcome.passes == settings_.max_passes;
    if (last && settings_.projections != Projections::none) project();  // with this pass's Phi_q
    if (!last || !System::kSaddle) evaluate_constraints();              // at the new q'
    if constexpr (!System::kSaddle) {
      phases_.enter(Phase::other);
      for (long k = 0; k < m_; ++k) lambda_[k] += alpha_ * Phi_[k];  // Eq. (1)
    }
  }
  return outcome;
}

template <int D, class System>
void HybridSimulation<D, System>::do_set_state(const State& state) {
  std::ranges::copy(state.q, q_.data());
  std::ranges::copy(state.v, v_.data());
  std::ranges::copy(state.a, a_.data());
  for (long k = 0; k < m_; ++k) lambda_[k] = state.lambda[constraints_.model_row(k)];
  // What a step that was not finite left behind the last entries, where zeros belong.
  std::fill_n(Delta_q_.data() + n_, padded(n_) - n_, 0.0);
  std::fill_n(y_.data() + m_, padded(m_) - m_, 0.0);
}

template <int D, class System>
void HybridSimulation<D, System>::do_get_state(State& state) const {
  std::copy_n(q_.data(), n_, state.q.begin());
  std::copy_n(v_.data(), n_, state.v.begin());
  std::copy_n(a_.data(), n_, state.a.begin());
  for (long k = 0; k < m_; ++k) state.lambda[constraints_.model_row(k)] = lambda_[k];
}

template <int D, class System>
bool HybridSimulation<D, System>::do_show_first_pass(FirstPass& pass) {
  if constexpr (System::kSaddle) {
    return false;
  } else {
    predict();
    evaluate_constraints();
    evaluate_residual();
    system_.assemble(Phi_q_.data());
    pass.q.assign(q_.data(), q_.data() + n_);
    pass.v.assign(v_.data(), v_.data() + n_);
    pass.a.assign(a_.data(), a_.data() + n_);
    pass.f.assign(Delta_q_.data(), Delta_q_.data() + n_);
    for (double& minus_f : pass.f) minus_f = -minus_f;
    pass.Phi.resize(m_);
    pass.Phi_q.resize(m_ * n_);
    for (long k = 0; k < m_; ++k) {
      const long row = constraints_.model_row(k);
      pass.Phi[row] = Phi_[k];
      for (int e = constraints_.firsts()[k]; e < constraints_.firsts()[k + 1]; ++e) {
        const int slot = constraints_.slots()[e];
        if (!slots_.is_fixed(slot)) pass.Phi_q[row * n_ + slot] += Phi_q_[e];
      }
    }
    pass.T.resize(n_ * n_);
    for (long i = 0; i < n_; ++i) {
      for (long j = 0; j <= i; ++j) pass.T[i * n_ + j] = system_.matrix()[system_.position()(i, j)];
    }
    return true;
  }
}

// Everything that is a function of time alone, at the end of the step.
template <int D, class System>
void HybridSimulation<D, System>::drive() {
  constraints_.drive(time());
  forces_.drive(time());
  for (const DrivenPoint& driven : model_.driven_points()) {
    for (int i = 0; i < D; ++i) {
      const TimeFunction::Sample now = driven.position[i].at(time());
      const int slot = slots_.of[driven.point] + i;
      q_[slot] = now.value;
      v_[slot] = now.rate;
      a_[slot] = now.acceleration;
    }
  }
  if (model_.driven_mass().empty()) return;
  std::ranges::copy(model_.force(), Q_.data());
  for (const auto& [coordinate, point, axis, value] : model_.driven_mass()) {
    Q_[coordinate] -= value * a_[slots_.of[point] + axis];
  }
}

// Eq. (2), applied to q' - q: with q' itself it cancels digits when coordinates are large.
template <int D, class System>
void HybridSimulation<D, System>::predict() {
  phases_.enter(Phase::other);
  const double half = dt_ * dt_ / 2, for_v = 2 / dt_, for_a = 4 / (dt_ * dt_);
  double *q = q_.data(), *v = v_.data(), *a = a_.data();
  for (long i = 0; i < n_; ++i) {
    const double difference = dt_ * v[i] + half * a[i];
    q[i] += difference;
    a[i] = for_a * difference - 2 * for_v * v[i] - a[i];
    v[i] = for_v * difference - v[i];
  }
  if (driven_) drive();
}

template <int D, class System>
void HybridSimulation<D, System>::evaluate_constraints() {
  phases_.enter(Phase::evaluation);
  constraints_.evaluate(q_.data(), Phi_.data(), Phi_q_.data());
}

// Eq. (3), shorter by Eq. (2): f = (dt^2/4) (M a' + Phi_q^T (lambda + alpha Phi) - Q); f_0 has no
// alpha Phi.
template <int D, class System>
void HybridSimulation<D, System>::evaluate_residual() {
  phases_.enter(Phase::evaluation);
  double* f = Delta_q_.data();
  mass_.multiply(a_.data(), f);
  for (long i = 0; i < n_; ++i) f[i] -= Q_[i];
  if constexpr (System::kSaddle) {
    constraints_.add_forces(Phi_q_.data(), lambda_.data(), f);
  } else {
    for (long k = 0; k < m_; ++k) y_[k] = lambda_[k] + alpha_ * Phi_[k];
    constraints_.add_forces(Phi_q_.data(), y_.data(), f);
  }
  if (forces_.any()) forces_.evaluate(q_.data(), v_.data(), f);
  const double minus_quarter = -dt_ * dt_ / 4;
  for (long i = 0; i < n_; ++i) f[i] *= minus_quarter;
}

// Adds Delta q; v' and a' follow by Eq. (2). True if Newton has converged, which NaN has not.
template <int D, class System>
bool HybridSimulation<D, System>::correct() {
  phases_.enter(Phase::other);
  const double for_v = 2 / dt_, for_a = 4 / (dt_ * dt_), tolerance = settings_.tolerance;
  double *q = q_.data(), *v = v_.data(), *a = a_.data();
  const double* Delta_q = Delta_q_.data();
  long large = 0;
  for (long i = 0; i < n_; ++i) {
    q[i] += Delta_q[i];
    v[i] += for_v * Delta_q[i];
    a[i] += for_a * Delta_q[i];
    large += std::abs(Delta_q[i]) <= tolerance ? 0 : 1;
  }
  return large == 0;
}

// Eq. (6) or (13), for v' - v* and a' - a*.
template <int D, class System>
void HybridSimulation<D, System>::project() {
  phases_.enter(Phase::projection);
  constraints_.first_derivative(Phi_q_.data(), v_.data(), y_.data());
  subtract_projection(v_);
  if (settings_.projections != Projections::both) return;
  phases_.enter(Phase::projection);
  constraints_.second_derivative(Phi_q_.data(), v_.data(), a_.data(), y_.data());
  subtract_projection(a_);
}

// What y_, the derivative of Phi, takes from v* or a*.
template <int D, class System>
void HybridSimulation<D, System>::subtract_projection(Array& result) {
  double* difference = Delta_q_.data();
  if constexpr (System::kSaddle) {
    phases_.enter(Phase::solve);
    system_.solve_constraints(difference, y_.data());
  } else {
    const double s = dt_ * dt_ / 4 * alpha_;
    for (long k = 0; k < m_; ++k) y_[k] *= s;
    std::fill_n(difference, padded(n_), 0.0);
    constraints_.add_forces(Phi_q_.data(), y_.data(), difference);
    phases_.enter(Phase::solve);
    system_.solve(difference);
  }
  for (long i = 0; i < n_; ++i) result[i] -= difference[i];
}

template class HybridSimulation<2, PenaltySystem<2, LltSolver>>;
template class HybridSimulation<2, PenaltySystem<2, LltBlocksSolver>>;
template class HybridSimulation<2, PenaltySystem<2, PotrfSolver>>;
template class HybridSimulation<2, PenaltySystem<2, PanelsSolver>>;
template class HybridSimulation<3, PenaltySystem<3, LltSolver>>;
template class HybridSimulation<3, PenaltySystem<3, LltBlocksSolver>>;
template class HybridSimulation<3, PenaltySystem<3, PotrfSolver>>;
template class HybridSimulation<3, PenaltySystem<3, PanelsSolver>>;
template class HybridSimulation<2, SaddleSystem<2, LltSolver>>;
template class HybridSimulation<2, SaddleSystem<2, PotrfSolver>>;
template class HybridSimulation<2, SaddleSystem<2, PanelsSolver>>;
template class HybridSimulation<3, SaddleSystem<3, LltSolver>>;
template class HybridSimulation<3, SaddleSystem<3, PotrfSolver>>;
template class HybridSimulation<3, SaddleSystem<3, PanelsSolver>>;

}  // namespace mbs::hybrid_dense
