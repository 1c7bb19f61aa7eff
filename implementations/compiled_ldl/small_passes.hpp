// SmallStepper<N, D>: predictor, Newton's passes, projections. Part of small_stepper.hpp.
#pragma once

#include "small_stepper.hpp"

namespace mbs::compiled_ldl {

template <int N, int D>
StepOutcome SmallStepper<N, D>::do_step() {
  phases_.enter(Phase::other);
  if (drivers_.any()) {
    gravity_.put(force_.data());
    drivers_.drive(time(), q_.data(), constraints_.values.data(), force_.data());
    drivers_.put_velocities(v_.data(), false);
  }
  predict();
  StepOutcome outcome;
  outcome.status = StepStatus::pass_limit;
  for (int pass = 1; pass <= settings_.max_passes; ++pass) {
    outcome.passes = pass;
    phases_.enter(Phase::evaluation);
    linearize(pass == 1 ? 0.0 : settings_.penalty);
    phases_.enter(Phase::factorization);
    Row change;
    if (!factors_.factorize_and_solve(matrix_, y_, change)) {
      outcome.status = StepStatus::factorization_failed;
      return outcome;
    }
    phases_.enter(Phase::other);
    apply(change);
    if (change.is_within(settings_.tolerance)) {
      outcome.status = StepStatus::converged;
      break;
    }
  }
  phases_.enter(Phase::evaluation);
  constraints_.template evaluate<false>(q_.data(), settings_.penalty, matrix_, y_);
  project();
  return outcome;
}

/// Eq. (2) on the difference that is left after rounding, so that v and a follow what q does.
template <int N, int D>
void SmallStepper<N, D>::predict() {
  const double step = settings_.step, to_v = 2.0 / step, to_a = 1.0 / h_, damped = 4.0 / step;
  const Row q = Row::of(q_.data()), v = Row::of(v_.data()), a = Row::of(a_.data());
  Row moved, rate, acceleration;
  for (int r = 0; r < Row::kVectors; ++r) {
    moved.v[r] = q.v[r] + (step * v.v[r] + step * step / 2.0 * a.v[r]);
    const auto difference = moved.v[r] - q.v[r];
    rate.v[r] = to_v * difference - v.v[r];
    acceleration.v[r] = to_a * difference - damped * v.v[r] - a.v[r];
  }
  moved.put(q_.data());
  rate.put(v_.data());
  acceleration.put(a_.data());
}

template <int N, int D>
void SmallStepper<N, D>::linearize(double change) {
  std::conditional_t<kInRegisters<N>, Matrix, Matrix&> matrix = matrix_;
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) matrix.column[j] = constants_.column[j];
  Row y = Row::zero();
  forces_.add(q_.data(), v_.data(), matrix, y);
  constraints_.template evaluate<true>(q_.data(), change, matrix, y);
  Row inertia[2] = {Row::of(force_.data()), Row::zero()};  // two, for latency
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) inertia[j % 2].add(-a_[j], mass_.column[j]);
  y.add(h_, inertia[0]);
  y.add(h_, inertia[1]);
  if (kInRegisters<N>) matrix_ = matrix;
  y_ = y;
}

template <int N, int D>
void SmallStepper<N, D>::apply(const Row& change) {
  const double to_v = 2.0 / settings_.step, to_a = to_v * to_v;
  Row q = Row::of(q_.data()), v = Row::of(v_.data()), a = Row::of(a_.data());
  q.add(1.0, change);
  v.add(to_v, change);
  a.add(to_a, change);
  q.put(q_.data());
  v.put(v_.data());
  a.put(a_.data());
}

template <int N, int D>
void SmallStepper<N, D>::project() {
  if (settings_.projections == Projections::none) return;
  if (++unprojected_ < settings_.projections_every) return;
  unprojected_ = 0;
  phases_.enter(Phase::projection);
  factors_.prepare();
  drivers_.put_velocities(v_.data(), true);
  project(v_.data(), nullptr, drivers_.velocity());
  if (settings_.projections == Projections::velocity) return;
  drivers_.put_velocities(v_.data(), false);
  project(a_.data(), v_.data(), drivers_.acceleration());
}

/// Eq. (6) for what it changes, as Stepper::project_penalty().
template <int N, int D>
void SmallStepper<N, D>::project(double* x, const double* v, const Prescribed* prescribed) {
  Row y = Row::zero();
  constraints_.project(x, v, prescribed, y);
  Row corrected = Row::of(x);
  corrected.add(1.0, factors_.solve(y));
  corrected.put(x);
}

}  // namespace mbs::compiled_ldl
