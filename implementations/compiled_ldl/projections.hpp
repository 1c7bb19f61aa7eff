// Stepper: projections, Eqs. (6), (13) and (15). Part of stepper.hpp.
#pragma once

#include "stepper.hpp"

namespace mbs::compiled_ldl {

template <typename S, typename F, int D>
bool Stepper<S, F, D>::project(StepOutcome& outcome) {
  if (settings_.projections == Projections::none) return true;
  if (++unprojected_ < settings_.projections_every) return true;
  unprojected_ = 0;
  phases_.enter(Phase::projection);
  auto& s = system_;
  const auto solve = [&](S* x, bool of_velocity) {
    if (refines_) {
      std::copy(x, x + s.program.padded, star_.data());
      return refine(x, star_.data(), of_velocity, outcome);
    }
    if (s.saddle) {
      project_saddle(x, of_velocity && !s.drivers.any() ? nullptr : velocity_terms_.data());
    } else {
      project_penalty(x, of_velocity ? nullptr : s.v.data());
    }
    return true;
  };
  const bool lists_terms = s.saddle || refines_;
  if (lists_terms && s.drivers.any()) s.drivers.rate_terms(s.constraints, velocity_terms_.data());
  if (!solve(s.v.data(), true)) return false;
  if (settings_.projections == Projections::velocity) return true;
  phases_.enter(Phase::projection);
  if (lists_terms) {
    s.drivers.acceleration_terms(s.constraints, s.v.data(), velocity_terms_.data());
  }
  return solve(s.a.data(), false);
}

/// x, with zero in place of what fixed points have.
template <typename S, typename F, int D>
const S* Stepper<S, F, D>::without_fixed(const S* x) {
  if (!system_.drivers.any()) return x;
  std::copy(x, x + system_.program.padded, difference_.data());
  return difference_.data();
}

/// Eq. (6) for what it changes. T is T₀ + (Δt²/4) α Φqᵀ Φq with the Φq of the last pass, so that
/// (6) is T (v' − v*) = −(Δt²/4) α (Φqᵀ Φq v* + Φqᵀ Φt), the first with that Φq: nothing has to
/// cancel, and M is not needed. With v, x is the acceleration.
template <typename S, typename F, int D>
void Stepper<S, F, D>::project_penalty(S* x, const S* v) {
  auto& s = system_;
  S* y = s.y.data();
  for (int i = 0; i < s.program.padded; ++i) y[i] = S(0.0);
  const S factor = s.h * s.alpha;
  s.constraints.add_projection(v == nullptr ? without_fixed(x) : x, v, factor, y);
  if (s.drivers.any() && v == nullptr) s.drivers.add_rate_terms(s.constraints, factor, y);
  if (s.drivers.any() && v != nullptr) s.drivers.add_acceleration_terms(s.constraints, factor, y);
  phases_.enter(Phase::solve);
  s.solve();
  phases_.enter(Phase::projection);
  for_each_row(s.program.size, s.program.padded, [=](int i) { x[i] += y[i]; });
}

/// Eq. (13) for what it changes, likewise; `terms` is Φt or Φ̇q v' + Φ̇t, nullptr: zero.
template <typename S, typename F, int D>
void Stepper<S, F, D>::project_saddle(S* x, const S* terms) {
  auto& s = system_;
  std::fill(s.y.begin(), s.y.end(), S(0.0));
  s.constraints.product(without_fixed(x), s.terms.data(), true);
  for (int k = 0; terms != nullptr && k < s.constraints.count(); ++k) s.terms[k] += terms[k];
  s.constrain(s.terms.data());
  phases_.enter(Phase::solve);
  s.solve();
  phases_.enter(Phase::projection);
  s.take_multipliers(nullptr, S(0.0));
  const S* y = s.y.data();
  for_each_row(s.program.size, s.program.padded, [=](int i) { x[i] += y[i]; });
}

/// y = right-hand sides of Eq. (15) at x, given v* or a*.
template <typename S, typename F, int D>
void Stepper<S, F, D>::refinement_residual(const S* x, const S* given, bool of_velocity) {
  auto& s = system_;
  for (int i = 0; i < s.program.padded; ++i) difference_[i] = given[i] - x[i];
  s.product(difference_.data());
  S* terms = s.terms.data();
  s.constraints.product(x, terms);  // with what driven points have of v'
  if (of_velocity) {
    s.drivers.subtract_rates(terms);
  } else {
    for (int k = 0; k < s.constraints.count(); ++k) terms[k] += velocity_terms_[k];
  }
  if (!s.saddle) {
    s.constrain(terms);
    return;
  }
  for (int k = 0; k < s.constraints.count(); ++k) terms[k] -= s.epsilon * multipliers_[k];
  s.constrain(terms);
  for (int k = 0; k < s.constraints.count(); ++k) terms[k] = -multipliers_[k];
  s.constraints.add_transposed(terms, s.y.data());
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
bool Stepper<S, F, D>::refine(S* x, const S* given, bool of_velocity, StepOutcome& outcome) {
  auto& s = system_;
  const bool kept = settings_.tangent == TangentReuse::kept;
  const S bound = (of_velocity ? S(2.0) / step_ : S(1.0) / s.h) * tolerance_;
  std::fill(multipliers_.begin(), multipliers_.end(), S(0.0));
  S previous = S(0.0);
  for (int i = 0; i < 5; ++i) {
    phases_.enter(Phase::projection);
    refinement_residual(x, given, of_velocity);
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
