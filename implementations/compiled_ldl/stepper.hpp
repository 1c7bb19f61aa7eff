// One simulation: the step of paper/README.md in every scheme and setting.
#pragma once

#include <memory>

#include "history.hpp"
#include "mbs/simulation.hpp"
#include "system.hpp"

namespace mbs::compiled_ldl {

template <typename S, typename F, int D>
class Stepper final : public Simulation {
 public:
  Stepper(const Model& model, const StepSettings& settings);

 protected:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

 private:
  StepOutcome trapezoidal_step();
  void predict();
  bool run_passes(StepOutcome& outcome);
  bool factorizes(int pass) const;
  bool solve_pass(StepOutcome& outcome);
  S apply_pass();
  bool finish(bool updates, StepOutcome& outcome);
  void judge_factors(int pass, S change, S previous);
  bool project(StepOutcome& outcome);
  void project_once(S* x, const S* v, const S* given);
  bool refine(S* x, const S* v, const S* given, StepOutcome& outcome);
  S take_correction();
  bool renew_factors();
  void refinement_residual(const S* x, const S* v, const S* given);
  // rattle.hpp
  StepOutcome rattle_step();
  bool stage(S length, StepOutcome& outcome);
  bool move(S length, StepOutcome& outcome);
  void find_acceleration();
  void refine_velocity();
  void refine_acceleration();
  void solve_constraints(const S* errors);
  // multistep.hpp
  StepOutcome multistep_step();
  StepOutcome recur();
  void apply_to_history(S to_a);
  void complete();

  static constexpr bool kDouble = std::is_same_v<S, double> && std::is_same_v<F, double>;

  StepSettings settings_;
  System<S, F, D> system_;
  bool reuses_, refines_;
  bool at_final_;  // projections have Φq of the final q'
  S step_, tolerance_;
  bool due_ = true;              // factors are to be renewed
  int unprojected_ = 0;          // steps since the last projection
  Array<S> velocity_terms_;      // of constraints: Φ̇q v' for RATTLE
  Array<S> star_, multipliers_;  // refinement: v* or a*, ν
  Array<S> difference_;          // refinement: v* − v' or a* − a'
  Array<S> right_hand_side_;
  std::unique_ptr<History> history_;  // of the multistep method
  bool is_complete_ = true;           // v, a and λ are those of q
};

// Predictor and Newton's passes.

template <typename S, typename F, int D>
Stepper<S, F, D>::Stepper(const Model& model, const StepSettings& settings)
    : Simulation(model, settings),
      settings_(settings),
      system_(std::vector<const Model*>{&model}, std::vector<StepSettings>{settings}),
      reuses_(settings.tangent != TangentReuse::none),
      refines_(reuses_ || !std::is_same_v<S, F>),
      at_final_(refines_ || (!system_.saddle && std::is_same_v<S, float>)),
      step_(static_cast<S>(settings.step)),
      tolerance_(static_cast<S>(settings.tolerance)),
      velocity_terms_(system_.constraints.count(), S(0.0)),
      star_(system_.rows.extent, S(0.0)),
      multipliers_(system_.constraints.count(), S(0.0)),
      difference_(system_.rows.extent, S(0.0)),
      right_hand_side_(system_.rows.extent, S(0.0)) {
  if (settings.scheme != Scheme::multistep6) return;
  const Program& program = system_.program;
  history_ = std::make_unique<History>(program.size, program.padded, settings.step);
}

template <typename S, typename F, int D>
void Stepper<S, F, D>::do_set_state(const State& state) {
  system_.put(0, state);
  due_ = true;
  unprojected_ = 0;
  if (history_) history_->forget();
  is_complete_ = true;
  if (!system_.rattle) return;
  system_.evaluate();
  system_.assemble();
  std::fill(system_.y.begin(), system_.y.end(), S(0.0));
  system_.factorize_and_solve();
  find_acceleration();
}

template <typename S, typename F, int D>
void Stepper<S, F, D>::do_get_state(State& state) const {
  if constexpr (kDouble) {
    // No simulation is a constant one; nothing that a step reads changes.
    if (!is_complete_) const_cast<Stepper*>(this)->complete();
  }
  system_.get(0, state);
}

template <typename S, typename F, int D>
StepOutcome Stepper<S, F, D>::do_step() {
  phases_.enter(Phase::other);
  if constexpr (kDouble) {
    if (history_) return multistep_step();
  }
  return system_.rattle ? rattle_step() : trapezoidal_step();
}

template <typename S, typename F, int D>
StepOutcome Stepper<S, F, D>::trapezoidal_step() {
  StepOutcome outcome;
  if (reuses_) outcome.factorizations = 0;
  if (system_.drivers.any()) system_.drive(time());
  predict();
  if (!run_passes(outcome)) {
    outcome.status = StepStatus::factorization_failed;
    due_ = true;
  }
  return outcome;
}

/// Eq. (2) on the difference that is left after rounding, so that v and a follow what q does.
template <typename S, typename F, int D>
void Stepper<S, F, D>::predict() {
  S* q = system_.q.data();
  S* v = system_.v.data();
  S* a = system_.a.data();
  const S half = step_ * step_ / S(2.0), to_v = S(2.0) / step_, to_a = S(1.0) / system_.h;
  const S damped = S(4.0) / step_;
  for (int i = 0; i < system_.program.padded; ++i) {
    const S moved = q[i] + (step_ * v[i] + half * a[i]);
    const S difference = moved - q[i];
    q[i] = moved;
    a[i] = to_a * difference - damped * v[i] - a[i];
    v[i] = to_v * difference - v[i];
  }
}

template <typename S, typename F, int D>
bool Stepper<S, F, D>::run_passes(StepOutcome& outcome) {
  phases_.enter(Phase::evaluation);
  system_.evaluate();
  const bool at_convergence = settings_.multipliers == MultiplierUpdate::converged;
  bool updated = false;
  S previous = S(0.0);
  outcome.status = StepStatus::pass_limit;
  for (int pass = 1;; ++pass) {
    outcome.passes = pass;
    if (!solve_pass(outcome)) return false;
    const S change = apply_pass();
    const bool converged = change <= tolerance_;
    judge_factors(pass, change, previous);
    previous = change;
    const bool updates = !system_.saddle && (converged || !at_convergence);
    if (converged && (!at_convergence || updated)) outcome.status = StepStatus::converged;
    if (outcome.status == StepStatus::converged || pass == settings_.max_passes) {
      return finish(updates, outcome);
    }
    phases_.enter(Phase::evaluation);
    updates ? system_.evaluate_and_update() : system_.evaluate();
    updated = converged;
  }
}

/// λ and the projections, after the last correction. Φ alone leaves Φq what it is in the factors.
template <typename S, typename F, int D>
bool Stepper<S, F, D>::finish(bool updates, StepOutcome& outcome) {
  if (outcome.status == StepStatus::pass_limit) due_ = true;
  phases_.enter(Phase::evaluation);
  if (at_final_) {
    updates ? system_.evaluate_and_update() : system_.evaluate();
  } else if (updates) {
    system_.update();
  }
  return project(outcome);
}

template <typename S, typename F, int D>
bool Stepper<S, F, D>::factorizes(int pass) const {
  switch (settings_.tangent) {
    case TangentReuse::none:
      return true;
    case TangentReuse::step:
      return pass == 1;
    case TangentReuse::kept:
      return due_;
  }
  return true;
}

template <typename S, typename F, int D>
bool Stepper<S, F, D>::solve_pass(StepOutcome& outcome) {
  phases_.enter(Phase::evaluation);
  const bool renews = factorizes(outcome.passes);
  system_.begin_residual(renews);
  if (renews) {
    phases_.enter(Phase::assembly);
    system_.assemble();
    phases_.enter(Phase::evaluation);
  }
  system_.finish_residual();
  if (!renews) {
    phases_.enter(Phase::solve);
    system_.solve();
    return true;
  }
  if (reuses_) ++outcome.factorizations;
  due_ = false;
  phases_.enter(Phase::factorization);
  return system_.factorize_and_solve();
}

/// q', v', a' and λ of the saddle-point form with the solution; max|Δq|.
template <typename S, typename F, int D>
S Stepper<S, F, D>::apply_pass() {
  phases_.enter(Phase::other);
  if (system_.saddle) system_.take_multipliers(system_.lambda.data(), S(1.0) / system_.h);
  return system_.apply(S(2.0) / step_);
}

/// Factors that are kept become due when convergence slows.
template <typename S, typename F, int D>
void Stepper<S, F, D>::judge_factors(int pass, S change, S previous) {
  if (pass < 2) return;
  if (!(change <= previous / S(4.0)) && !(change <= tolerance_)) due_ = true;
}

// Projections, Eqs. (6), (13) and (15).

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

#include "multistep.hpp"
#include "rattle.hpp"
