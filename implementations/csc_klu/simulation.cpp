// The step of paper/README.md over sparse storage, and the choice of a scheme.
#include "simulation.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "constraint_rates.hpp"
#include "equations.hpp"
#include "multistep.hpp"
#include "newmark.hpp"
#include "rattle.hpp"
#include "storage.hpp"
#include "tangent.hpp"
#include "trapezoidal.hpp"

namespace mbs::csc_klu {
namespace {

template <int dim, TangentSolver Solver>
class NewtonSimulation final : public Simulation {
 public:
  NewtonSimulation(const Model& model, const StepSettings& settings, Order order)
      : Simulation(model, settings),
        settings_(settings),
        equations_(model, settings.step),
        tangent_pattern_(model, equations_.jacobian_pattern, equations_.force_pattern, order),
        tangent_(tangent_pattern_, mass_values(model, tangent_pattern_.pattern),
                 equations_.weight * settings.penalty),
        rates_(equations_),
        right_(equations_.n, 0.0),
        change_(equations_.n, 0.0),
        solver_(tangent_.pattern(), assemble_tangent(),
                {Structure::Kind::definite, tangent_pattern_.order}) {}

 private:
  void do_set_state(const State& state) override {
    equations_.set_state(state);
    solver_.start_again();
  }
  void do_get_state(State& state) const override { equations_.get_state(state); }

  StepOutcome do_step() override {
    Equations<dim>& e = equations_;
    if (e.has_drivers) e.drivers.sample(time(), e.q.data(), e.v.data(), e.a.data());
    if (e.has_forces) e.forces.set_time(time());
    predict(e.n, settings_.step, e.q.data(), e.v.data(), e.a.data());
    phases_.enter(Phase::evaluation);
    e.evaluate_constraints();
    StepOutcome outcome{StepStatus::pass_limit, 0};
    bool goes_on = true;
    while (goes_on) {
      ++outcome.passes;
      phases_.enter(Phase::evaluation);
      e.evaluate_residual(settings_.penalty, right_.data());
      phases_.enter(Phase::assembly);
      assemble_tangent();
      phases_.enter(Phase::factorization);
      if (!solver_.factorize(tangent_.values())) {
        phases_.enter(Phase::other);
        return {StepStatus::factorization_failed, outcome.passes};
      }
      phases_.enter(Phase::solve);
      solver_.solve(right_);
      phases_.enter(Phase::other);
      if (correct(e.n, settings_.step, settings_.tolerance, right_.data(), e.v.data(),
                  e.a.data())) {
        outcome.status = StepStatus::converged;
      }
      goes_on = outcome.status != StepStatus::converged && outcome.passes < settings_.max_passes;
      if (!goes_on) project();
      for (int i = 0; i < e.n; ++i) e.q[i] += right_[i];
      phases_.enter(Phase::evaluation);
      if (goes_on) {
        e.evaluate_constraints();
      } else {
        e.evaluate_phi();
      }
      phases_.enter(Phase::other);
      e.update_multipliers(settings_.penalty);
    }
    return outcome;
  }

  std::span<const double> assemble_tangent() {
    tangent_.assemble(equations_.jacobian);
    if (equations_.has_forces) tangent_.add(equations_.forces);
    return tangent_.values();
  }

  /// Eq. (6) with the last factors, solved for what it changes; q is still that of T.
  void project() {
    using Rates = ConstraintRates<dim>;
    if (settings_.projections == Projections::none) return;
    project(&Rates::velocity, equations_.v.data());
    if (settings_.projections == Projections::both) {
      project(&Rates::acceleration, equations_.a.data());
    }
    phases_.enter(Phase::other);
  }
  /// The same of x alone; `rates` are those with x.
  void project(typename ConstraintRates<dim>::Result (ConstraintRates<dim>::*rates)(), double* x) {
    const Equations<dim>& e = equations_;
    phases_.enter(Phase::projection);
    e.jacobian.multiply_transposed((rates_.*rates)().data(), -e.weight * settings_.penalty,
                                   change_.data());
    phases_.enter(Phase::solve);
    solver_.solve(change_);
    phases_.enter(Phase::projection);
    for (int i = 0; i < e.n; ++i) x[i] += change_[i];
  }

  const StepSettings settings_;
  Equations<dim> equations_;
  const TangentPattern<dim> tangent_pattern_;
  Tangent<dim> tangent_;
  ConstraintRates<dim> rates_;
  std::vector<double> right_;   ///< n; right-hand side and solution of Eq. (4)
  std::vector<double> change_;  ///< n; the same of Eq. (6)
  Solver solver_;
};

/// Whether "The step" is asked for, with no setting of its own.
bool is_default(const StepSettings& settings) {
  return settings.scheme == Scheme::penalty && settings.projections_every == 1 &&
         settings.multipliers == MultiplierUpdate::every_pass &&
         settings.tangent == TangentReuse::none && !settings.geometric_stiffness;
}

bool is_trapezoidal(const StepSettings& settings) {
  return settings.scheme == Scheme::penalty || settings.scheme == Scheme::saddle_point;
}

template <TangentSolver Solver>
std::unique_ptr<Simulation> create_newton(const Model& model, const StepSettings& settings,
                                          Order order = Order::shallow) {
  if (model.dimension() == 2) {
    return std::make_unique<NewtonSimulation<2, Solver>>(model, settings, order);
  }
  return std::make_unique<NewtonSimulation<3, Solver>>(model, settings, order);
}

}  // namespace

template <TangentSolver Solver>
std::unique_ptr<Simulation> create_simulation(const Model& model, const StepSettings& settings) {
  if (settings.scheme == Scheme::multistep6) return create_multistep<Solver>(model, settings);
  if (!is_trapezoidal(settings)) return create_rattle<Solver>(model, settings);
  if (!is_default(settings)) return create_trapezoidal<Solver>(model, settings);
  return create_newton<Solver>(model, settings);
}

std::unique_ptr<Simulation> create_ordered(const Model& model, const StepSettings& settings,
                                           Order order) {
  return settings.scheme == Scheme::penalty
             ? create_newton<Refactorization>(model, settings, order)
             : create_trapezoidal<Refactorization>(model, settings, order);
}

template std::unique_ptr<Simulation> create_simulation<Refactorization>(const Model&,
                                                                        const StepSettings&);
template std::unique_ptr<Simulation> create_simulation<Factorization>(const Model&,
                                                                      const StepSettings&);
template std::unique_ptr<Simulation> create_simulation<GuardedRefactorization>(const Model&,
                                                                               const StepSettings&);

}  // namespace mbs::csc_klu
