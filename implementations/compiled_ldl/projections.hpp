// Stepper: projections, Eqs. (6), (13) and (15). Part of stepper.hpp.
#pragma once

#include "stepper.hpp"

namespace mbs::compiled_ldl {

template <typename S, typename F, int D>
bool Stepper<S, F, D>::project(StepOutcome& outcome) {
  if (settings_.projections == Projections::none) return true;
  if (++unprojected_ < settings_.projections_every) return true;
  unprojected_ = 0;
  auto& s = system_;
  const auto solve = [&](S* x, const S* v, const S* given) {
    if (refines_) return refine(x, v, given, outcome);
    project_once(x, v, given);
    return true;
  };
  if (!solve(s.v.data(), nullptr, s.drivers.rates())) return false;
  if (settings_.projections == Projections::velocity) return true;
  return solve(s.a.data(), s.v.data(), s.drivers.accelerations());
}

/// Eq. (6) or (13) for what it changes: nothing has to cancel, and M is not needed. Before Φq is
/// evaluated at the final q', it is that of the factors. With v, x is the acceleration; `given`: ṡ
/// or s̈.
template <typename S, typename F, int D>
void Stepper<S, F, D>::project_once(S* x, const S* v, const S* given) {
  auto& s = system_;
  phases_.enter(Phase::projection);
  std::fill(s.y.begin(), s.y.end(), S(0.0));
  if (s.saddle) {
    s.constrain_rates(x, v, given);
  } else {
    s.constraints.add_projection(x, v, given, -s.h * s.alpha, s.y.data());
  }
  phases_.enter(Phase::solve);
  s.solve();
  phases_.enter(Phase::projection);
  const S* y = s.y.data();
  for_each_row(s.program.size, s.program.padded, [=](int i) { x[i] += y[i]; });
  // Those of y, cleared before, would be narrow stores that vectors of y wait for.
  if (s.saddle) s.clear_multipliers(x);
}

/// y = right-hand sides of Eq. (15) at x, with v* or a* in star_.
template <typename S, typename F, int D>
void Stepper<S, F, D>::refinement_residual(const S* x, const S* v, const S* given) {
  auto& s = system_;
  for (int i = 0; i < s.program.padded; ++i) difference_[i] = star_[i] - x[i];
  s.product(difference_.data());
  S* terms = s.terms.data();
  s.constraints.product(x, terms, v, given);
  if (!s.saddle) {
    s.constrain(terms);
    return;
  }
  for (int k = 0; k < s.constraints.count(); ++k) terms[k] -= s.epsilon * multipliers_[k];
  s.constrain(terms);
  s.constraints.add_transposed(multipliers_.data(), S(-1.0), s.y.data());
}

/// Max|δ| of a solution; κ of the saddle-point form moves to `terms`.
template <typename S, typename F, int D>
S Stepper<S, F, D>::take_correction() {
  auto& s = system_;
  if (s.saddle) {
    for (int k = 0; k < s.constraints.count(); ++k) s.terms[k] = s.y[s.constraints.row(k)];
    s.take_multipliers(nullptr, S(0.0));
  }
  return s.largest();
}

/// Assembles and factorizes at the final q'; C and K need the forces there.
template <typename S, typename F, int D>
bool Stepper<S, F, D>::renew_factors() {
  auto& s = system_;
  phases_.enter(Phase::evaluation);
  s.forces.add(s.q.data(), s.v.data(), S(1.0), s.y.data());
  phases_.enter(Phase::assembly);
  s.assemble();
  phases_.enter(Phase::factorization);
  s.y = right_hand_side_;
  return s.factorize_and_solve();
}

/// Eq. (15); false if a pivot was not accepted.
template <typename S, typename F, int D>
bool Stepper<S, F, D>::refine(S* x, const S* v, const S* given, StepOutcome& outcome) {
  auto& s = system_;
  std::copy(x, x + s.program.padded, star_.data());
  const bool kept = settings_.tangent == TangentReuse::kept;
  const S bound = (v == nullptr ? S(2.0) / step_ : S(1.0) / s.h) * tolerance_;
  std::fill(multipliers_.begin(), multipliers_.end(), S(0.0));
  S previous = S(0.0);
  for (int i = 0; i < 5; ++i) {
    phases_.enter(Phase::projection);
    refinement_residual(x, v, given);
    if (kept) right_hand_side_ = s.y;
    phases_.enter(Phase::solve);
    s.solve();
    S change = take_correction();
    if (i > 0 && !(change <= previous / S(2.0))) {
      if (!kept) return true;
      ++outcome.factorizations;
      if (!renew_factors()) return false;
      change = take_correction();
    }
    for (int k = 0; s.saddle && k < s.constraints.count(); ++k) multipliers_[k] += s.terms[k];
    for (int k = 0; k < s.program.padded; ++k) x[k] += s.y[k];
    if (change <= bound) return true;
    previous = change;
  }
  return true;
}

}  // namespace mbs::compiled_ldl
