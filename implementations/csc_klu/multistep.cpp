// The symmetric multistep method of sixth order: one saddle-point factorization a step.
#include "multistep.hpp"

#include <algorithm>
#include <limits>

#include "history.hpp"
#include "rattle.hpp"
#include "rattle_step.hpp"

namespace mbs::csc_klu {
namespace {

template <int dim, TangentSolver Solver>
class MultistepSimulation final : public Simulation {
 public:
  MultistepSimulation(const Model& model, const StepSettings& settings)
      : Simulation(model, settings),
        model_(model),
        settings_(settings),
        push_(kLeading * settings.step * settings.step),
        rattle_(model, settings, phases_),
        moves_(model.variables()),
        accelerations_(model.variables()) {
    rattle_.start();
  }

 private:
  /// Makes v, a and lambda for a q; apart, so that it leaves pivots and Phi_q of the motion alone.
  struct Observer {
    Observer(const Model& model, const StepSettings& settings) : rattle(model, settings, idle) {}
    PhaseClock idle;
    RattleStep<dim, Solver> rattle;
  };

  void do_set_state(const State& state) override {
    rattle_.restart(state);
    if (observer_) observer_->rattle.system().start_again();
    started_ = 0;
    is_under_way_ = false;
  }

  void do_get_state(State& state) const override {
    const Equations<dim>& e = rattle_.equations();
    if (!is_under_way_) return e.get_state(state);
    if (!observer_) observer_ = std::make_unique<Observer>(model_, settings_);
    Equations<dim>& seen = observer_->rattle.equations();
    std::ranges::copy(e.q, seen.q.begin());
    differentiate(e.n, settings_.step, moves_, accelerations_, seen.v.data());
    if (!observer_->rattle.settle(true)) {
      std::fill_n(seen.a.begin(), seen.n, std::numeric_limits<double>::quiet_NaN());
      std::ranges::fill(seen.lambda, std::numeric_limits<double>::quiet_NaN());
    }
    seen.get_state(state);
  }

  StepOutcome do_step() override {
    if (started_ < History::kLength) return start_up();
    if (!rattle_.factorize()) {
      phases_.enter(Phase::other);
      return {StepStatus::factorization_failed, 1, 1};
    }
    predict();
    const StepOutcome outcome = iterate();
    moves_.advance();
    accelerations_.advance();
    is_under_way_ = true;
    return outcome;
  }

  /// A step of rattle6, of which w and a are kept.
  StepOutcome start_up() {
    const Equations<dim>& e = rattle_.equations();
    double* const w = moves_.back(0);
    std::copy_n(e.q.begin(), e.n, w);
    std::copy_n(e.a.begin(), e.n, accelerations_.back(0));
    const StepOutcome outcome = rattle_.advance();
    if (outcome.status == StepStatus::factorization_failed) return outcome;
    for (int i = 0; i < e.n; ++i) w[i] = e.q[i] - w[i];
    moves_.advance();
    accelerations_.advance();
    ++started_;
    return outcome;
  }

  /// a_n, w_n and q', its Phi and Phi_q, and the right-hand side of the first pass.
  void predict() {
    Equations<dim>& e = rattle_.equations();
    phases_.enter(Phase::other);
    extrapolate(e.n, settings_.step, moves_, accelerations_);
    phases_.enter(Phase::evaluation);
    double* const right = rattle_.system().right().data();
    e.mass.multiply(accelerations_.back(0), right);
    for (int i = 0; i < e.n; ++i) right[i] = e.weighted_force[i] - right[i];
    if (e.has_forces) e.forces.evaluate(e.q.data(), e.v.data(), right);
    const double* const w = moves_.back(0);
    for (int i = 0; i < e.n; ++i) {
      right[i] *= push_;
      e.q[i] += w[i];
    }
    e.evaluate_constraints();
  }

  /// All passes of a step.
  StepOutcome iterate() {
    Equations<dim>& e = rattle_.equations();
    StepOutcome outcome{StepStatus::pass_limit, 0, 1};
    bool goes_on = true;
    while (goes_on) {
      if (outcome.passes > 0) std::fill_n(rattle_.system().right().begin(), e.n, 0.0);
      rattle_.solve(e.phi);
      phases_.enter(Phase::other);
      ++outcome.passes;
      const bool is_within =
          correct_last(e.n, settings_.tolerance, 1.0 / push_, rattle_.system().right().data(),
                       e.q.data(), moves_.back(0), accelerations_.back(0));
      goes_on = outcome.passes < settings_.max_passes && (outcome.passes < kFewest || !is_within);
      if (!goes_on && is_within) outcome.status = StepStatus::converged;
      phases_.enter(Phase::evaluation);
      e.evaluate_constraints();
    }
    phases_.enter(Phase::other);
    return outcome;
  }

  static constexpr int kFewest = 2;  ///< passes: the first leaves a tenth of Phi

  const Model& model_;
  const StepSettings settings_;
  const double push_;               ///< b_0 dt^2, s^2
  RattleStep<dim, Solver> rattle_;  ///< q, Phi, R; once under way its v, a and lambda are of old
  History moves_, accelerations_;   ///< w and a
  int started_ = 0;                 ///< steps of the start
  bool is_under_way_ = false;       ///< the last step was by Eq. (17)
  mutable std::unique_ptr<Observer> observer_;  ///< made when a state is first asked for
};

}  // namespace

template <TangentSolver Solver>
std::unique_ptr<Simulation> create_multistep(const Model& model, const StepSettings& settings) {
  if (model.dimension() == 2) {
    return std::make_unique<MultistepSimulation<2, Solver>>(model, settings);
  }
  return std::make_unique<MultistepSimulation<3, Solver>>(model, settings);
}

template std::unique_ptr<Simulation> create_multistep<Refactorization>(const Model&,
                                                                       const StepSettings&);
template std::unique_ptr<Simulation> create_multistep<Factorization>(const Model&,
                                                                     const StepSettings&);
template std::unique_ptr<Simulation> create_multistep<GuardedRefactorization>(const Model&,
                                                                              const StepSettings&);

}  // namespace mbs::csc_klu
