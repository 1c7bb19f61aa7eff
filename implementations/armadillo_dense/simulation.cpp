// The step over dense matrices.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::armadillo_dense {

template <class System>
DenseSimulation<System>::DenseSimulation(const Model& model, const StepSettings& settings)
    : mbs::Simulation(model, settings),
      settings_(settings),
      system_(model, settings),
      n_(model.variables()),
      m_(model.constraints()),
      q_(system_.layout().positions(model)),
      v_(system_.layout().zeros()),
      a_(system_.layout().zeros()),
      lambda_(m_, arma::fill::zeros) {
  std::ranges::copy(model.initial_velocity(), v_.begin());
}

template <class System>
void DenseSimulation<System>::do_set_state(const State& state) {
  std::ranges::copy(state.q, q_.begin());
  std::ranges::copy(state.v, v_.begin());
  std::ranges::copy(state.a, a_.begin());
  std::ranges::copy(state.lambda, lambda_.begin());
}

template <class System>
void DenseSimulation<System>::do_get_state(State& state) const {
  std::copy_n(q_.begin(), n_, state.q.begin());
  std::copy_n(v_.begin(), n_, state.v.begin());
  std::copy_n(a_.begin(), n_, state.a.begin());
  std::copy_n(lambda_.begin(), m_, state.lambda.begin());
}

template <class System>
StepOutcome DenseSimulation<System>::do_step() {
  if (system_.is_driven()) system_.drive(time(), q_, v_, a_);
  predict();
  phases_.enter(Phase::evaluation);
  system_.evaluate(q_);
  StepOutcome outcome{.status = StepStatus::pass_limit, .passes = 0};
  while (outcome.status == StepStatus::pass_limit && outcome.passes < settings_.max_passes) {
    ++outcome.passes;
    phases_.enter(Phase::evaluation);
    system_.residual(q_, v_, a_, lambda_);
    phases_.enter(Phase::assembly);
    system_.assemble();
    phases_.enter(Phase::factorization);
    if (!system_.factorize()) {
      phases_.enter(Phase::other);
      return {.status = StepStatus::factorization_failed, .passes = outcome.passes};
    }
    phases_.enter(Phase::solve);
    system_.solve();  // Eq. (4) or (12)
    phases_.enter(Phase::other);
    if (correct()) outcome.status = StepStatus::converged;
    phases_.enter(Phase::evaluation);
    if (outcome.status == StepStatus::converged || outcome.passes == settings_.max_passes) {
      system_.evaluate_last(q_);
    } else {
      system_.evaluate(q_);
    }
    phases_.enter(Phase::other);
    system_.update(lambda_);
  }
  project();
  return outcome;
}

template <class System>
void DenseSimulation<System>::predict() {
  const double step = settings_.step;
  const double half_square = step * step / 2.0;
  const double two = 2.0 / step;
  const double four = 4.0 / step;
  const double four_square = 4.0 / (step * step);
  double* __restrict const q = q_.memptr();
  double* __restrict const v = v_.memptr();
  double* __restrict const a = a_.memptr();
  for (arma::uword i = 0; i < n_; ++i) {
    const double predicted = q[i] + step * v[i] + half_square * a[i];
    const double difference = predicted - q[i];
    q[i] = predicted;
    a[i] = four_square * difference - four * v[i] - a[i];  // Eq. (2)
    v[i] = two * difference - v[i];                        // Eq. (2)
  }
}

template <class System>
bool DenseSimulation<System>::correct() {
  const double tolerance = settings_.tolerance;
  const double two = 2.0 / settings_.step;
  const double four_square = 4.0 / (settings_.step * settings_.step);
  double* __restrict const q = q_.memptr();
  double* __restrict const v = v_.memptr();
  double* __restrict const a = a_.memptr();
  const double* __restrict const delta = system_.solution().memptr();
  bool converged = true;
  for (arma::uword i = 0; i < n_; ++i) {
    q[i] += delta[i];
    v[i] += two * delta[i];          // Eq. (2)
    a[i] += four_square * delta[i];  // Eq. (2)
    converged &= std::abs(delta[i]) <= tolerance;
  }
  return converged;
}

template <class System>
void DenseSimulation<System>::project() {
  if (settings_.projections == Projections::none) return;
  phases_.enter(Phase::projection);
  system_.velocity_projection(v_);
  phases_.enter(Phase::solve);
  system_.solve();  // Eq. (6) or (13)
  phases_.enter(Phase::projection);
  v_.head(n_) += system_.solution();
  if (settings_.projections == Projections::velocity) {
    phases_.enter(Phase::other);
    return;
  }
  system_.acceleration_projection(v_, a_);
  phases_.enter(Phase::solve);
  system_.solve();  // Eq. (6) or (13)
  phases_.enter(Phase::other);
  a_.head(n_) += system_.solution();
}

template class DenseSimulation<PenaltySystem>;
template class DenseSimulation<PotrsSystem>;
template class DenseSimulation<SaddlePointSystem>;

}  // namespace mbs::armadillo_dense
