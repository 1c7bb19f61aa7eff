// The trapezoidal step with all settings: saddle-point form, kept factors, refined projections.
#include "trapezoidal.hpp"

#include <algorithm>
#include <vector>

#include "equations.hpp"
#include "newmark.hpp"
#include "newton_system.hpp"
#include "penalty_system.hpp"
#include "projection.hpp"
#include "saddle_system.hpp"

namespace mbs::csc_klu {
namespace {

template <int dim, NewtonSystem System>
class TrapezoidalSimulation final : public Simulation {
 public:
  TrapezoidalSimulation(const Model& model, const StepSettings& settings, Order order)
      : Simulation(model, settings),
        settings_(settings),
        equations_(model, settings.step),
        system_(model, settings, equations_, order),
        correction_(equations_.n, 0.0),
        projection_(settings.step, equations_, system_, phases_) {}

 private:
  void do_set_state(const State& state) override {
    equations_.set_state(state);
    system_.start_again();
    is_due_ = true;
    unprojected_ = 0;
  }
  void do_get_state(State& state) const override { equations_.get_state(state); }

  StepOutcome do_step() override {
    Equations<dim>& e = equations_;
    if (e.has_drivers) e.drivers.sample(time(), e.q.data(), e.v.data(), e.a.data());
    if (e.has_forces) e.forces.set_time(time());
    predict(e.n, settings_.step, e.q.data(), e.v.data(), e.a.data());
    phases_.enter(Phase::evaluation);
    e.evaluate_constraints();
    if (settings_.tangent != TangentReuse::kept) is_due_ = true;
    is_updated_ = false;
    const bool projects = ends_projected();
    StepOutcome outcome{StepStatus::pass_limit, 0, 0};
    if (!iterate(projects, outcome) || (projects && is_refined() && !refine(outcome))) {
      outcome.status = StepStatus::factorization_failed;
    }
    phases_.enter(Phase::other);
    if (outcome.status != StepStatus::converged) is_due_ = true;
    return outcome;
  }

  /// All passes of a step, and its projections unless they are refined; false if a factorization
  /// failed.
  bool iterate(bool projects, StepOutcome& outcome) {
    Equations<dim>& e = equations_;
    double before = 0.0;
    bool goes_on = true, is_slow = false;
    while (goes_on) {
      ++outcome.passes;
      phases_.enter(Phase::evaluation);
      system_.evaluate_residual();
      if (is_due_ && !factorize(outcome)) return false;
      phases_.enter(Phase::solve);
      system_.solve();
      phases_.enter(Phase::other);
      double* const correction = system_.right().data();
      const bool is_within =
          correct(e.n, settings_.step, settings_.tolerance, correction, e.v.data(), e.a.data());
      if (settings_.tangent == TangentReuse::kept) {
        const double size = largest(e.n, correction);
        is_slow = outcome.passes > 1 && !is_within && !(size <= before / 4.0);
        before = size;
      }
      if (has_converged(is_within)) outcome.status = StepStatus::converged;
      goes_on = outcome.status != StepStatus::converged && outcome.passes < settings_.max_passes;
      system_.take_multipliers();
      if (!goes_on && projects && !is_refined()) {
        std::copy_n(correction, e.n, correction_.begin());  // projections need right()
        project();
        add(correction_.data());
      } else {
        add(correction);
      }
      phases_.enter(Phase::evaluation);
      if (goes_on || (projects && is_refined())) {
        e.evaluate_constraints();
      } else if (System::kMultipliersNeedPhi) {
        e.evaluate_phi();
      }
      phases_.enter(Phase::other);
      update_multipliers(is_within);
      if (settings_.tangent == TangentReuse::none) is_due_ = true;
      if (is_slow) is_due_ = true;
    }
    return true;
  }

  void add(const double* correction) {
    Equations<dim>& e = equations_;
    for (int i = 0; i < e.n; ++i) e.q[i] += correction[i];
  }

  /// After a pass: whether the step has.
  [[nodiscard]] bool has_converged(bool is_within) const {
    return is_within && (settings_.multipliers == MultiplierUpdate::every_pass || is_updated_);
  }

  /// After a pass.
  void update_multipliers(bool is_within) {
    is_updated_ = is_within || settings_.multipliers == MultiplierUpdate::every_pass;
    if (is_updated_) system_.update_multipliers();
  }

  /// Whether projections are, by Eq. (15).
  [[nodiscard]] bool is_refined() const { return settings_.tangent != TangentReuse::none; }

  /// Assembles with Phi_q, C and K as they are.
  bool factorize(StepOutcome& outcome) {
    phases_.enter(Phase::assembly);
    system_.assemble();
    if (is_refined()) projection_.keep_stiffness();
    phases_.enter(Phase::factorization);
    ++outcome.factorizations;
    is_due_ = !system_.factorize();
    return !is_due_;
  }

  bool ends_projected() {
    if (++unprojected_ < settings_.projections_every) return false;
    unprojected_ = 0;
    return settings_.projections != Projections::none;
  }

  /// By Eq. (6) or (13); q is still that of the matrix.
  void project() {
    using Rates = ConstraintRates<dim>;
    projection_.solve(&Rates::velocity, equations_.v.data());
    if (settings_.projections == Projections::both) {
      projection_.solve(&Rates::acceleration, equations_.a.data());
    }
    phases_.enter(Phase::other);
  }

  /// Projects by Eq. (15); false if a factorization failed.
  bool refine(StepOutcome& outcome) {
    Equations<dim>& e = equations_;
    using Rates = ConstraintRates<dim>;
    const double h = settings_.step, tolerance = settings_.tolerance;
    const bool both = settings_.projections == Projections::both;
    const auto repair = [&] {
      if (settings_.tangent != TangentReuse::kept) return Repair::none;
      return factorize_at_end(outcome) ? Repair::done : Repair::failed;
    };
    return projection_.refine(&Rates::velocity, e.v.data(), (2.0 / h) * tolerance, repair) &&
           (!both || projection_.refine(&Rates::acceleration, e.a.data(),
                                        (4.0 / (h * h)) * tolerance, repair));
  }

  /// With C and K, too, of the final q'; what comes with them, Q, nobody needs.
  bool factorize_at_end(StepOutcome& outcome) {
    Equations<dim>& e = equations_;
    if (e.has_forces) e.forces.evaluate(e.q.data(), e.v.data(), system_.right().data());
    return factorize(outcome);
  }

  const StepSettings settings_;
  Equations<dim> equations_;
  System system_;
  std::vector<double> correction_;  ///< n; Delta q during projections
  Projection<dim, System> projection_;
  bool is_due_ = true;       ///< the next pass factorizes
  bool is_updated_ = false;  ///< the pass before updated lambda
  int unprojected_ = 0;      ///< steps since the last one that projections_every asked for
};

template <int dim, TangentSolver Solver>
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings, Order order) {
  using Penalty = TrapezoidalSimulation<dim, PenaltySystem<dim, Solver>>;
  using Saddle = TrapezoidalSimulation<dim, SaddleSystem<dim, Solver>>;
  if (settings.scheme == Scheme::penalty) return std::make_unique<Penalty>(model, settings, order);
  return std::make_unique<Saddle>(model, settings, order);
}

}  // namespace

template <TangentSolver Solver>
std::unique_ptr<Simulation> create_trapezoidal(const Model& model, const StepSettings& settings,
                                               Order order) {
  return model.dimension() == 2 ? create<2, Solver>(model, settings, order)
                                : create<3, Solver>(model, settings, order);
}

template std::unique_ptr<Simulation> create_trapezoidal<Refactorization>(const Model&,
                                                                         const StepSettings&,
                                                                         Order);
template std::unique_ptr<Simulation> create_trapezoidal<Factorization>(const Model&,
                                                                       const StepSettings&, Order);
template std::unique_ptr<Simulation> create_trapezoidal<GuardedRefactorization>(const Model&,
                                                                                const StepSettings&,
                                                                                Order);

}  // namespace mbs::csc_klu
