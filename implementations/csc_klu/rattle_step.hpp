// One step of RATTLE, and what makes v, a and lambda consistent with q.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "constraint_rates.hpp"
#include "equations.hpp"
#include "mbs/phase_clock.hpp"
#include "newmark.hpp"
#include "rattle_stages.hpp"
#include "saddle_system.hpp"

namespace mbs::csc_klu {

/// A state with the factors of R of Eq. (14), of which `phases`, which has to outlive this, books
/// the time. Starts at the model's initial position and velocity.
template <int dim, TangentSolver Solver>
class RattleStep {
 public:
  RattleStep(const Model& model, const StepSettings& settings, PhaseClock& phases)
      : settings_(settings),
        phases_(phases),
        stages_(stage_lengths(settings.scheme, settings.step)),
        equations_(model, kUnweighted),
        rates_(equations_),
        system_(model, settings, equations_, std::vector<ElementBlock>()),
        moved_(equations_.n, 0.0),
        force_(equations_.n, 0.0),
        zeros_(equations_.m, 0.0) {}

  [[nodiscard]] Equations<dim>& equations() { return equations_; }
  [[nodiscard]] const Equations<dim>& equations() const { return equations_; }
  [[nodiscard]] SaddleSystem<dim, Solver>& system() { return system_; }

  /// Takes over a state, then start(); nothing of the motion before has an influence.
  bool restart(const State& state) {
    equations_.set_state(state);
    system_.start_again();
    return start();
  }
  /// Factorizes R(q) and makes a and lambda consistent; false if the factorization failed.
  bool start() { return settle(false); }
  /// The same for v, too, if it is to be refined.
  bool settle(bool refines_velocity) {
    equations_.evaluate_constraints();
    if (!factorize()) return false;
    if (refines_velocity) refine_velocity();
    evaluate_forces();
    find_acceleration();
    return true;
  }

  /// All stages of a step; needs the factors of R(q).
  StepOutcome advance() {
    if (!has_factors_) return {StepStatus::factorization_failed, 1, 0};
    StepOutcome outcome{StepStatus::converged, 0, 0};
    for (const double h : stages_) {
      find_position(h, outcome);
      ++outcome.factorizations;
      if (!factorize()) {
        outcome.status = StepStatus::factorization_failed;
        break;
      }
      evaluate_forces();
      find_velocity(h);
      find_acceleration();
    }
    phases_.enter(Phase::other);
    return outcome;
  }

  /// Factorizes R with the Phi_q that there is; false if that failed.
  bool factorize() {
    phases_.enter(Phase::assembly);
    system_.assemble();
    phases_.enter(Phase::factorization);
    has_factors_ = system_.factorize();
    return has_factors_;
  }

  /// Completes the right-hand side by -rates (m) and solves; then the phase is `projection`.
  void solve(std::span<const double> rates) {
    system_.include_constraints(rates);
    phases_.enter(Phase::solve);
    system_.solve();
    phases_.enter(Phase::projection);
  }

 private:
  static constexpr int kMostRefinements = 5;
  static constexpr double kUnweighted = 2.0;  ///< a step (s) with dt^2/4 = 1: Equations gives Q

  /// q' of a stage, its Phi and Phi_q, with R(q); then moved_ is w.
  void find_position(double h, StepOutcome& outcome) {
    Equations<dim>& e = equations_;
    phases_.enter(Phase::other);
    std::copy_n(e.q.begin(), e.n, moved_.begin());
    for (int i = 0; i < e.n; ++i) e.q[i] += h * e.v[i] + (h * h / 2.0) * e.a[i];
    phases_.enter(Phase::evaluation);
    e.evaluate_constraints();
    double size = 0.0;
    int passes = 0;
    do {
      ++passes;
      std::fill_n(system_.right().begin(), e.n, 0.0);
      solve(e.phi);
      for (int i = 0; i < e.n; ++i) e.q[i] += system_.right()[i];
      size = largest(e.n, system_.right().data());
      phases_.enter(Phase::evaluation);
      e.evaluate_constraints();
    } while (!(size <= settings_.tolerance) && passes < settings_.max_passes);
    phases_.enter(Phase::other);
    outcome.passes += passes;
    if (!(size <= settings_.tolerance)) outcome.status = StepStatus::pass_limit;
    for (int i = 0; i < e.n; ++i) moved_[i] = (e.q[i] - moved_[i]) / h;
  }

  /// Q at q', in force_.
  void evaluate_forces() {
    Equations<dim>& e = equations_;
    phases_.enter(Phase::evaluation);
    std::ranges::copy(e.weighted_force, force_.begin());
    if (e.has_forces) e.forces.evaluate(e.q.data(), e.v.data(), force_.data());
  }

  /// v' of a stage, from w.
  void find_velocity(double h) {
    Equations<dim>& e = equations_;
    phases_.enter(Phase::projection);
    double* const right = system_.right().data();
    e.mass.multiply(moved_.data(), right);
    for (int i = 0; i < e.n; ++i) right[i] += (h / 2.0) * force_[i];
    solve(zeros_);
    std::copy_n(system_.right().begin(), e.n, e.v.begin());
    refine_velocity();
  }

  void refine_velocity() {
    Equations<dim>& e = equations_;
    const double enough = (2.0 / settings_.step) * settings_.tolerance;
    for (int k = 0; k < kMostRefinements; ++k) {
      std::fill_n(system_.right().begin(), e.n, 0.0);
      solve(rates_.velocity());
      for (int i = 0; i < e.n; ++i) e.v[i] += system_.right()[i];
      if (largest(e.n, system_.right().data()) <= enough) return;
    }
  }

  /// a' and lambda' of a stage.
  void find_acceleration() {
    Equations<dim>& e = equations_;
    const double h = settings_.step, enough = (4.0 / (h * h)) * settings_.tolerance;
    phases_.enter(Phase::projection);
    std::ranges::copy(force_, system_.right().begin());
    solve(rates_.velocity_term());
    std::copy_n(system_.right().begin(), e.n, e.a.begin());
    std::copy_n(system_.multipliers(), e.m, e.lambda.begin());
    for (int k = 0; k < kMostRefinements; ++k) {
      std::fill_n(system_.right().begin(), e.n, 0.0);
      solve(rates_.acceleration());
      for (int i = 0; i < e.n; ++i) e.a[i] += system_.right()[i];
      for (int i = 0; i < e.m; ++i) e.lambda[i] += system_.multipliers()[i];
      if (largest(e.n, system_.right().data()) <= enough) return;
    }
  }

  const StepSettings settings_;
  PhaseClock& phases_;
  const std::vector<double> stages_;  ///< s
  Equations<dim> equations_;
  ConstraintRates<dim> rates_;
  SaddleSystem<dim, Solver> system_;
  std::vector<double> moved_;        ///< n; q of the stage, then w
  std::vector<double> force_;        ///< n; Q(q')
  const std::vector<double> zeros_;  ///< m
  bool has_factors_ = false;
};

}  // namespace mbs::csc_klu
