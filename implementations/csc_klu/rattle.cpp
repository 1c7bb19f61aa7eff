// RATTLE of second, fourth and sixth order: stages of one saddle-point factorization each.
#include "rattle.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "constraint_rates.hpp"
#include "equations.hpp"
#include "newmark.hpp"
#include "rattle_stages.hpp"
#include "saddle_system.hpp"

namespace mbs::csc_klu {
namespace {

constexpr int kMostRefinements = 5;
constexpr double kUnweighted = 2.0;  ///< a step (s) with dt^2/4 = 1: Equations gives Q itself

template <int dim, TangentSolver Solver>
class RattleSimulation final : public Simulation {
 public:
  RattleSimulation(const Model& model, const StepSettings& settings)
      : Simulation(model, settings),
        settings_(settings),
        stages_(stage_lengths(settings.scheme, settings.step)),
        equations_(model, kUnweighted),
        rates_(equations_),
        system_(model, settings, equations_, {}),
        moved_(equations_.n, 0.0),
        force_(equations_.n, 0.0),
        zeros_(equations_.m, 0.0) {
    start();
  }

 private:
  void do_set_state(const State& state) override {
    equations_.set_state(state);
    start();
  }
  void do_get_state(State& state) const override { equations_.get_state(state); }

  StepOutcome do_step() override {
    if (!has_factors_) return {StepStatus::factorization_failed, 1, 0};
    StepOutcome outcome{StepStatus::converged, 0, 0};
    for (const double h : stages_) {
      find_position(h, outcome);
      factorize(outcome);
      if (!has_factors_) {
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

  /// Factorizes R(q) and makes a and lambda consistent.
  void start() {
    StepOutcome ignored;
    equations_.evaluate_constraints();
    factorize(ignored);
    if (!has_factors_) return;
    evaluate_forces();
    find_acceleration();
  }

  void factorize(StepOutcome& outcome) {
    phases_.enter(Phase::assembly);
    system_.assemble();
    phases_.enter(Phase::factorization);
    has_factors_ = system_.factorize();
    ++outcome.factorizations;
  }

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
    solve(rates_.partial_acceleration());
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

  /// Completes the right-hand side by -rates (m) and solves; then the phase is `projection`.
  void solve(std::span<const double> rates) {
    system_.include_constraints(rates);
    phases_.enter(Phase::solve);
    system_.solve();
    phases_.enter(Phase::projection);
  }

  const StepSettings settings_;
  const std::vector<double> stages_;  ///< s
  Equations<dim> equations_;
  ConstraintRates<dim> rates_;
  SaddleSystem<dim, Solver> system_;
  std::vector<double> moved_;        ///< n; q of the stage, then w
  std::vector<double> force_;        ///< n; Q(q')
  const std::vector<double> zeros_;  ///< m
  bool has_factors_ = false;
};

/// Throws Unsupported unless forces depend on positions only.
void check(const Model& model) {
  if (!model.driven_points().empty() || !model.driven_values().empty()) {
    throw Unsupported("RATTLE is for models without drivers");
  }
  const auto is_damped = [](const auto& spring) { return spring.damping != 0.0; };
  if (std::ranges::any_of(model.springs(), is_damped) ||
      std::ranges::any_of(model.torsion_springs(), is_damped)) {
    throw Unsupported("RATTLE is for models without dampers");
  }
}

}  // namespace

template <TangentSolver Solver>
std::unique_ptr<Simulation> create_rattle(const Model& model, const StepSettings& settings) {
  check(model);
  if (model.dimension() == 2) return std::make_unique<RattleSimulation<2, Solver>>(model, settings);
  return std::make_unique<RattleSimulation<3, Solver>>(model, settings);
}

template std::unique_ptr<Simulation> create_rattle<Refactorization>(const Model&,
                                                                    const StepSettings&);
template std::unique_ptr<Simulation> create_rattle<Factorization>(const Model&,
                                                                  const StepSettings&);
template std::unique_ptr<Simulation> create_rattle<GuardedRefactorization>(const Model&,
                                                                           const StepSettings&);

}  // namespace mbs::csc_klu
