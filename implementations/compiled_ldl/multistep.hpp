// Stepper: symmetric multistep method, Eq. (17). Part of stepper.hpp.
#pragma once

#include "rattle.hpp"
#include "stepper.hpp"

namespace mbs::compiled_ldl {

/// The first steps are those of rattle6, which make the history.
template <typename S, typename F, int D>
StepOutcome Stepper<S, F, D>::multistep_step() {
  if (history_->is_full()) {
    is_complete_ = false;
    return recur();
  }
  const auto& s = system_;
  history_->begin_step();
  std::copy_n(s.a.data(), s.program.padded, history_->a());
  std::copy_n(s.q.data(), s.program.padded, history_->w());
  const StepOutcome outcome = rattle_step();
  for (int i = 0; i < s.program.padded; ++i) history_->w()[i] = s.q[i] - history_->w()[i];
  return outcome;
}

template <typename S, typename F, int D>
StepOutcome Stepper<S, F, D>::recur() {
  auto& s = system_;
  StepOutcome outcome{StepStatus::pass_limit, 1, 1};
  phases_.enter(Phase::evaluation);
  s.evaluate();
  const S* force = s.force.data();
  if (s.forces.any()) {
    std::copy(s.force.begin(), s.force.end(), star_.begin());
    s.forces.add(s.q.data(), s.v.data(), S(1.0), star_.data());
    force = star_.data();
  }
  phases_.enter(Phase::assembly);
  s.assemble();
  phases_.enter(Phase::other);
  history_->predict(s.q.data());
  phases_.enter(Phase::evaluation);
  const S scale = History::kB[0] * step_ * step_;
  s.mass.residual(force, history_->a(), scale, s.y.data());
  s.constrain_values();
  phases_.enter(Phase::factorization);
  if (!s.factorize_and_solve()) {
    outcome.status = StepStatus::factorization_failed;
    return outcome;
  }
  for (;; ++outcome.passes) {
    phases_.enter(Phase::other);
    apply_to_history(S(1.0) / scale);
    if (outcome.passes > 1 && s.largest() <= tolerance_) {
      outcome.status = StepStatus::converged;
      return outcome;
    }
    if (outcome.passes >= settings_.max_passes) return outcome;
    phases_.enter(Phase::evaluation);
    std::fill(s.y.begin(), s.y.end(), S(0.0));
    s.constrain_values();
    phases_.enter(Phase::solve);
    s.solve();
  }
}

/// q', w_n and a_n with the solution.
template <typename S, typename F, int D>
void Stepper<S, F, D>::apply_to_history(S to_a) {
  auto& s = system_;
  s.take_multipliers(nullptr, S(0.0));
  S* q = s.q.data();
  S* w = history_->w();
  S* a = history_->a();
  const S* y = s.y.data();
  for_each_row(s.program.size, s.program.padded, [=](int i) {
    q[i] += y[i];
    w[i] += y[i];
    a[i] += to_a * y[i];
  });
}

/// v, a and λ, of which nothing enters the recursion.
template <typename S, typename F, int D>
void Stepper<S, F, D>::complete() {
  auto& s = system_;
  s.evaluate();
  s.assemble();
  std::fill(s.y.begin(), s.y.end(), S(0.0));
  s.factorize_and_solve();
  s.take_multipliers(nullptr, S(0.0));
  history_->find_velocity(s.v.data());
  refine_velocity();
  find_acceleration();
  is_complete_ = true;
}

}  // namespace mbs::compiled_ldl
