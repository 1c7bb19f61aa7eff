// The stages of RATTLE.
#include "rattle_simulation.hpp"

#include "rattle_stages.hpp"

namespace mbs::eigen_sparse {

template <class Solver>
RattleSimulation<Solver>::RattleSimulation(const Model& model, const StepSettings& settings)
    : Simulation(model, settings),
      settings_(settings),
      stages_(rattle_stages(settings)),
      mechanism_(model, numbered_by(model, Solver::elimination_order, Tuning::own)),
      equations_(model, 4.0 / (settings.penalty * settings.step * settings.step), mechanism_,
                 Stiffness::none, Tuning::own),
      start_(model.variables()),
      force_(model.variables()),
      curvature_(model.constraints()),
      delta_(model.variables()),
      multiplier_(model.constraints()) {
  mechanism_.add_forces(model, equations_.matrix().layout(), settings.step);
}

template <class Solver>
void RattleSimulation<Solver>::do_set_state(const State& state) {
  mechanism_.set_state(state);
  mechanism_.constraints.evaluate(mechanism_.q);
  if (!factorize()) return;
  mechanism_.applied_force(force_);
  find_acceleration();
}

template <class Solver>
void RattleSimulation<Solver>::do_get_state(State& state) const {
  mechanism_.get_state(state);
}

template <class Solver>
StepOutcome RattleSimulation<Solver>::do_step() {
  if (!factorized_) return {StepStatus::factorization_failed, 1, 0};  // that of R(q)
  StepOutcome outcome{StepStatus::converged, 0, 0};
  for (const double h : stages_) {
    if (!advance(h, outcome)) {
      outcome.status = StepStatus::factorization_failed;
      break;
    }
  }
  phases_.enter(Phase::other);
  return outcome;
}

/// One stage; false if the factorization failed.
template <class Solver>
bool RattleSimulation<Solver>::advance(double h, StepOutcome& outcome) {
  phases_.enter(Phase::other);
  Mechanism& m = mechanism_;
  auto q = m.q.head(start_.size());
  start_ = q;
  q += h * m.v.head(start_.size()) + (0.5 * h * h) * m.a;
  if (!find_position(outcome)) outcome.status = StepStatus::pass_limit;
  ++outcome.factorizations;
  if (!factorize()) return false;
  phases_.enter(Phase::evaluation);
  m.applied_force(force_);
  start_ = (q - start_) / h;  // w
  find_velocity(h);
  find_acceleration();
  return true;
}

/// Brings q' onto the constraints with the factors of R(q); false at the limit of passes.
template <class Solver>
bool RattleSimulation<Solver>::find_position(StepOutcome& outcome) {
  Mechanism& m = mechanism_;
  phases_.enter(Phase::evaluation);
  m.constraints.evaluate(m.q);
  for (int pass = 1; pass <= settings_.max_passes; ++pass) {
    ++outcome.passes;
    delta_.setZero();
    multiplier_ = -m.constraints.phi();
    solve();
    m.q.head(delta_.size()) += delta_;
    const double largest = largest_of(delta_);
    phases_.enter(Phase::evaluation);
    m.constraints.evaluate(m.q);
    if (largest <= settings_.tolerance) return true;
  }
  return false;
}

/// R(q') of Eq. (14).
template <class Solver>
bool RattleSimulation<Solver>::factorize() {
  phases_.enter(Phase::assembly);
  equations_.matrix().refresh(mechanism_.constraints.jacobian());
  phases_.enter(Phase::factorization);
  factorized_ = equations_.factorize();
  return factorized_;
}

/// v' from w and Q, then refined until it satisfies Phi_q v' = 0.
template <class Solver>
void RattleSimulation<Solver>::find_velocity(double h) {
  Mechanism& m = mechanism_;
  auto v = m.v.head(delta_.size());
  phases_.enter(Phase::projection);
  delta_ = (0.5 * h) * force_;
  delta_.noalias() += m.mass * start_;
  multiplier_.setZero();
  solve();
  v = delta_;
  for (int solves = 0; solves < kMaxRefinements; ++solves) {
    phases_.enter(Phase::projection);
    delta_.setZero();
    multiplier_.setZero();
    multiplier_.noalias() -= m.constraints.jacobian() * v;
    solve();
    v += delta_;
    if (largest_of(delta_) <= (2.0 / settings_.step) * settings_.tolerance) break;
  }
}

/// a' and lambda' from Q and v', then refined until a' satisfies the constraints.
template <class Solver>
void RattleSimulation<Solver>::find_acceleration() {
  Mechanism& m = mechanism_;
  phases_.enter(Phase::projection);
  m.accelerations(curvature_);
  delta_ = force_;
  multiplier_ = -curvature_;
  solve();
  m.a = delta_;
  m.lambda = multiplier_;
  const double h = settings_.step;
  for (int solves = 0; solves < kMaxRefinements; ++solves) {
    phases_.enter(Phase::projection);
    delta_.setZero();
    multiplier_ = -curvature_;
    multiplier_.noalias() -= m.constraints.jacobian() * m.a;
    solve();
    m.a += delta_;
    m.lambda += multiplier_;
    if (largest_of(delta_) <= (4.0 / (h * h)) * settings_.tolerance) break;
  }
}

template <class Solver>
void RattleSimulation<Solver>::solve() {
  phases_.enter(Phase::solve);
  equations_.solve(delta_, multiplier_);
  phases_.enter(Phase::other);
}

template class RattleSimulation<SimplicialSolver<double>>;
template class RattleSimulation<SuperluSolver<double>>;

}  // namespace mbs::eigen_sparse
