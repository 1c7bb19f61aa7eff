// The simulation with default settings: the step of paper/README.md and no choices.
#include "simulation.hpp"

namespace mbs::eigen_dense {

Simulation::Simulation(const Model& model, const StepSettings& settings)
    : mbs::Simulation(model, settings),
      settings_(settings),
      layout_(model),
      assembly_(model, settings, layout_),
      solver_(model.variables()),
      motion_(model, layout_),
      solution_(Eigen::VectorXd::Zero(model.variables())) {}

StepOutcome Simulation::do_step() {
  phases_.enter(Phase::other);
  if (assembly_.driven()) assembly_.drive(time(), motion_.q, motion_.v);
  motion_.predict(settings_.step);
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(motion_.q);
  StepOutcome outcome{StepStatus::pass_limit, 0};
  for (bool converged = false; !converged && outcome.passes < settings_.max_passes;) {
    ++outcome.passes;
    if (!pass(converged)) {
      outcome.status = StepStatus::factorization_failed;
      return outcome;
    }
    if (converged) outcome.status = StepStatus::converged;
  }
  project();
  return outcome;
}

bool Simulation::pass(bool& converged) {
  phases_.enter(Phase::evaluation);
  assembly_.residual(motion_.q, motion_.v, motion_.a, motion_.lambda, solution_);
  phases_.enter(Phase::assembly);
  assembly_.tangent(solver_.matrix());
  phases_.enter(Phase::factorization);
  const bool factorized = solver_.factorize();
  phases_.enter(Phase::solve);
  if (factorized) solver_.solve(solution_);  // Eq. (4)
  phases_.enter(Phase::other);
  if (!factorized) return false;

  converged = motion_.correct(solution_.data(), settings_.step, settings_.tolerance);
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(motion_.q);
  phases_.enter(Phase::other);
  motion_.lambda += settings_.penalty * assembly_.Phi();  // Eq. (1)
  return true;
}

void Simulation::project() {
  if (settings_.projections == Projections::none) return;
  phases_.enter(Phase::projection);
  assembly_.project_velocity(motion_.q, motion_.v, solution_);
  phases_.enter(Phase::solve);
  solver_.solve(solution_);  // Eq. (6)
  motion_.v.head(motion_.a.size()) = solution_;
  if (settings_.projections == Projections::both) {
    phases_.enter(Phase::projection);
    assembly_.project_acceleration(motion_.q, motion_.v, motion_.a, solution_);
    phases_.enter(Phase::solve);
    solver_.solve(solution_);  // Eq. (6)
    motion_.a.swap(solution_);
  }
  phases_.enter(Phase::other);
}

}  // namespace mbs::eigen_dense
