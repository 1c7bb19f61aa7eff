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
      solution_(Eigen::VectorXd::Zero(model.variables())),
      acceleration_change_(solution_) {}

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
  if (outcome.status != StepStatus::factorization_failed) project();
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
  if (converged || outcome.passes == settings_.max_passes) start_projections();
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(motion_.q);
  phases_.enter(Phase::other);
  motion_.lambda += settings_.penalty * assembly_.Phi();  // Eq. (1)
}

void Simulation::start_projections() {
  if (settings_.projections == Projections::none) return;
  phases_.enter(Phase::projection);
  assembly_.start_projection(motion_.v, solution_);
  if (settings_.projections == Projections::both) {
    assembly_.start_projection(motion_.a, acceleration_change_);
  }
}

void Simulation::project() {
  if (settings_.projections == Projections::none) return;
  phases_.enter(Phase::projection);
  assembly_.finish_velocity(motion_.q, solution_);
  phases_.enter(Phase::solve);
  solver_.solve(solution_);  // Eq. (6)
  motion_.v.head(motion_.a.size()) += solution_;
  if (settings_.projections == Projections::both) {
    phases_.enter(Phase::projection);
    assembly_.finish_acceleration(motion_.q, motion_.v, acceleration_change_);
    phases_.enter(Phase::solve);
    solver_.solve(acceleration_change_);  // Eq. (6)
    motion_.a += acceleration_change_;
  }
  phases_.enter(Phase::other);
}

}  // namespace mbs::eigen_dense
