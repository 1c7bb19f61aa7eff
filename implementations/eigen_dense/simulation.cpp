// The simulation with default settings: the step of paper/README.md and no choices.
#include "simulation.hpp"

namespace mbs::eigen_dense {

Simulation::Simulation(const Model& model, const StepSettings& settings, Eigen::Index unblocked)
    : mbs::Simulation(model, settings),
      settings_(settings),
      layout_(model),
      assembly_(model, settings, layout_),
      solver_(model.variables(), unblocked),
      motion_(model, layout_),
      solution_(Eigen::VectorXd::Zero(model.variables())) {}

StepOutcome Simulation::do_step() {
  phases_.enter(Phase::other);
  if (assembly_.driven()) assembly_.drive(time(), motion_.q, motion_.v);
  motion_.predict(settings_.step);
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(motion_.q);
  StepOutcome outcome{StepStatus::pass_limit, 0};
  while (outcome.status == StepStatus::pass_limit && outcome.passes < settings_.max_passes) {
    pass(outcome);
  }
  return outcome;
}

void Simulation::pass(StepOutcome& outcome) {
  ++outcome.passes;
  phases_.enter(Phase::evaluation);
  assembly_.residual(motion_.q, motion_.v, motion_.a, motion_.lambda, solution_);
  phases_.enter(Phase::assembly);
  assembly_.tangent(solver_.matrix());
  phases_.enter(Phase::factorization);
  const bool factorized = solver_.factorize();
  phases_.enter(Phase::solve);
  if (factorized) solver_.solve(solution_);  // Eq. (4)
  phases_.enter(Phase::other);
  if (!factorized) {
    outcome.status = StepStatus::factorization_failed;
    return;
  }
  const bool converged = motion_.correct(solution_.data(), settings_.step, settings_.tolerance);
  if (converged) outcome.status = StepStatus::converged;
  const bool last = converged || outcome.passes == settings_.max_passes;
  if (last) project();
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(motion_.q, !last);
  phases_.enter(Phase::other);
  motion_.lambda += settings_.penalty * assembly_.Phi();  // Eq. (1)
}

void Simulation::project() {
  if (settings_.projections == Projections::none) return;
  phases_.enter(Phase::projection);
  solve_projection(assembly_.velocity_error(motion_.v));
  motion_.v.head(motion_.a.size()) += solution_;
  if (settings_.projections == Projections::velocity) return;
  phases_.enter(Phase::projection);
  solve_projection(assembly_.acceleration_error(motion_.v, motion_.a));
  motion_.a += solution_;
}

void Simulation::solve_projection(const Eigen::VectorXd& error) {
  solution_.setZero();
  assembly_.subtract_penalty(error, solution_);
  phases_.enter(Phase::solve);
  solver_.solve(solution_);  // Eq. (6)
}

}  // namespace mbs::eigen_dense
