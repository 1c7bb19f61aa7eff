// Stepper: RATTLE and its compositions, Eq. (14). Part of stepper.hpp.
#pragma once

#include <cmath>
#include <span>

#include "stepper.hpp"

namespace mbs::compiled_ldl {

/// Lengths of a step's stages, in steps (paper/README.md, "RATTLE"); of the first steps of the
/// multistep method too.
inline std::span<const double> stage_lengths(Scheme scheme) {
  static constexpr double kOnce[] = {1.0};
  static const double g = 1.0 / (4.0 - std::cbrt(4.0));
  static const double kFourth[] = {g, g, 1.0 - 4.0 * g, g, g};
  static constexpr double w1 = -1.17767998417887100694641568096431573;
  static constexpr double w2 = 0.235573213359358133684793182978534602;
  static constexpr double w3 = 0.784513610477557263819497633866349876;
  static constexpr double w0 = 1.0 - 2.0 * (w1 + w2 + w3);
  static constexpr double kSixth[] = {w3, w2, w1, w0, w1, w2, w3};
  if (scheme == Scheme::rattle4) return kFourth;
  if (scheme == Scheme::rattle6 || scheme == Scheme::multistep6) return kSixth;
  return kOnce;
}

template <typename S, typename F, int D>
StepOutcome Stepper<S, F, D>::rattle_step() {
  StepOutcome outcome;
  outcome.status = StepStatus::converged;
  outcome.factorizations = 0;
  for (const double length : stage_lengths(settings_.scheme)) {
    if (stage(static_cast<S>(length * settings_.step), outcome)) continue;
    outcome.status = StepStatus::factorization_failed;
    break;
  }
  return outcome;
}

template <typename S, typename F, int D>
bool Stepper<S, F, D>::stage(S length, StepOutcome& outcome) {
  auto& s = system_;
  if (!move(length, outcome)) outcome.status = StepStatus::pass_limit;
  phases_.enter(Phase::assembly);
  s.assemble();
  phases_.enter(Phase::evaluation);
  // w is in place of v. R [v' − w; ·] = [(h/2) Q(q'); −Φq w], so that M w need not cancel.
  std::copy(s.force.begin(), s.force.end(), s.y.begin());
  if (s.forces.any()) s.forces.add(s.q.data(), s.v.data(), S(1.0), s.y.data());
  for (int i = 0; i < s.program.padded; ++i) s.y[i] *= length / S(2.0);
  s.constraints.product(s.v.data(), s.terms.data());
  s.constrain(s.terms.data());
  phases_.enter(Phase::factorization);
  ++outcome.factorizations;
  if (!s.factorize_and_solve()) return false;
  phases_.enter(Phase::projection);
  s.take_multipliers(nullptr, S(0.0));
  for (int i = 0; i < s.program.padded; ++i) s.v[i] += s.y[i];
  refine_velocity();
  find_acceleration();
  return true;
}

/// Steps 1 and 2 of a stage: q', and w in place of v; false at the limit of passes.
template <typename S, typename F, int D>
bool Stepper<S, F, D>::move(S length, StepOutcome& outcome) {
  auto& s = system_;
  S* q = s.q.data();
  S* v = s.v.data();
  for (int i = 0; i < s.program.padded; ++i) v[i] += length / S(2.0) * s.a[i];
  for (int i = 0; i < s.program.padded; ++i) q[i] += length * v[i];
  const S inverse = S(1.0) / length;
  for (int pass = 1; pass <= settings_.max_passes; ++pass) {
    ++outcome.passes;
    phases_.enter(Phase::evaluation);
    s.evaluate();
    solve_constraints(s.phi.data());
    phases_.enter(Phase::other);
    for (int i = 0; i < s.program.padded; ++i) {
      q[i] += s.y[i];
      v[i] += inverse * s.y[i];
    }
    if (s.largest() <= tolerance_) {
      s.evaluate();
      return true;
    }
  }
  s.evaluate();
  return false;
}

/// y = δ of R [δ; ν] = [0; −errors]; ν in `multipliers_`.
template <typename S, typename F, int D>
void Stepper<S, F, D>::solve_constraints(const S* errors) {
  auto& s = system_;
  std::fill(s.y.begin(), s.y.end(), S(0.0));
  s.constrain(errors);
  phases_.enter(Phase::solve);
  s.solve();
  std::fill(multipliers_.begin(), multipliers_.end(), S(0.0));
  s.take_multipliers(multipliers_.data(), S(1.0));
}

template <typename S, typename F, int D>
void Stepper<S, F, D>::refine_velocity() {
  auto& s = system_;
  for (int i = 0; i < 5; ++i) {
    phases_.enter(Phase::projection);
    s.constraints.product(s.v.data(), s.terms.data());
    solve_constraints(s.terms.data());
    for (int k = 0; k < s.program.padded; ++k) s.v[k] += s.y[k];
    if (s.largest() <= S(2.0) / step_ * tolerance_) return;
  }
}

/// Step 5 of a stage.
template <typename S, typename F, int D>
void Stepper<S, F, D>::find_acceleration() {
  auto& s = system_;
  phases_.enter(Phase::projection);
  std::copy(s.force.begin(), s.force.end(), s.y.begin());
  if (s.forces.any()) s.forces.add(s.q.data(), s.v.data(), S(1.0), s.y.data());
  s.constraints.velocity_terms(s.v.data(), velocity_terms_.data());
  s.constrain(velocity_terms_.data());
  phases_.enter(Phase::solve);
  s.solve();
  std::fill(s.lambda.begin(), s.lambda.end(), S(0.0));
  s.take_multipliers(s.lambda.data(), S(1.0));
  std::copy(s.y.data(), s.y.data() + s.program.padded, s.a.data());
  refine_acceleration();
}

template <typename S, typename F, int D>
void Stepper<S, F, D>::refine_acceleration() {
  auto& s = system_;
  for (int i = 0; i < 5; ++i) {
    phases_.enter(Phase::projection);
    s.constraints.product(s.a.data(), s.terms.data());
    for (int k = 0; k < s.constraints.count(); ++k) s.terms[k] += velocity_terms_[k];
    solve_constraints(s.terms.data());
    for (int k = 0; k < s.program.padded; ++k) s.a[k] += s.y[k];
    for (int k = 0; k < s.constraints.count(); ++k) s.lambda[k] += multipliers_[k];
    if (s.largest() <= S(4.0) / (step_ * step_) * tolerance_) return;
  }
}

}  // namespace mbs::compiled_ldl
