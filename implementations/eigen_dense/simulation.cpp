// One simulation: the state and the step of paper/README.md, over Assembly and Solver.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::eigen_dense {

Simulation::Simulation(const Model& model, const StepSettings& settings)
    : mbs::Simulation(model, settings),
      settings_(settings),
      layout_(model),
      assembly_(model, settings, layout_),
      solver_(model.variables()),
      q_(layout_.initial_position(model)),
      v_(Eigen::VectorXd::Zero(q_.size())),
      a_(Eigen::VectorXd::Zero(model.variables())),
      lambda_(Eigen::VectorXd::Zero(model.constraints())),
      solution_(Eigen::VectorXd::Zero(model.variables())) {
  std::ranges::copy(model.initial_velocity(), v_.begin());
}

void Simulation::do_set_state(const State& state) {
  std::ranges::copy(state.q, q_.begin());
  std::ranges::copy(state.v, v_.begin());
  std::ranges::copy(state.a, a_.begin());
  std::ranges::copy(state.lambda, lambda_.begin());
}

void Simulation::do_get_state(State& state) const {
  std::copy_n(q_.begin(), a_.size(), state.q.begin());
  std::copy_n(v_.begin(), a_.size(), state.v.begin());
  std::ranges::copy(a_, state.a.begin());
  std::ranges::copy(lambda_, state.lambda.begin());
}

StepOutcome Simulation::do_step() {
  phases_.enter(Phase::other);
  if (assembly_.driven()) assembly_.drive(time(), q_, v_);
  predict();
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(q_);
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

void Simulation::predict() {
  const double step = settings_.step;
  double* const q = q_.data();
  double* const v = v_.data();
  double* const a = a_.data();
  for (Eigen::Index i = 0; i < a_.size(); ++i) {
    const double predicted = q[i] + step * v[i] + 0.5 * step * step * a[i];
    const double change = predicted - q[i];
    q[i] = predicted;
    a[i] = 4.0 / (step * step) * change - 4.0 / step * v[i] - a[i];  // Eq. (2)
    v[i] = 2.0 / step * change - v[i];                               // Eq. (2)
  }
}

bool Simulation::update() {
  const double velocity_factor = 2.0 / settings_.step;
  const double acceleration_factor = 4.0 / (settings_.step * settings_.step);
  double* const q = q_.data();
  double* const v = v_.data();
  double* const a = a_.data();
  const double* const delta = solution_.data();
  Eigen::Index beyond = 0;
  for (Eigen::Index i = 0; i < a_.size(); ++i) {
    q[i] += delta[i];
    v[i] += velocity_factor * delta[i];                      // Eq. (2)
    a[i] += acceleration_factor * delta[i];                  // Eq. (2)
    beyond += !(std::abs(delta[i]) <= settings_.tolerance);  // so that NaN is beyond it
  }
  return beyond == 0;
}

bool Simulation::pass(bool& converged) {
  phases_.enter(Phase::evaluation);
  assembly_.residual(q_, v_, a_, lambda_, solution_);
  phases_.enter(Phase::assembly);
  assembly_.tangent(solver_.matrix());
  phases_.enter(Phase::factorization);
  const bool factorized = solver_.factorize();
  phases_.enter(Phase::solve);
  if (factorized) solver_.solve(solution_);  // Eq. (4)
  phases_.enter(Phase::other);
  if (!factorized) return false;

  converged = update();
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(q_);
  phases_.enter(Phase::other);
  lambda_ += settings_.penalty * assembly_.Phi();  // Eq. (1)
  return true;
}

void Simulation::project() {
  if (settings_.projections == Projections::none) return;
  phases_.enter(Phase::projection);
  assembly_.project_velocity(q_, v_, solution_);
  phases_.enter(Phase::solve);
  solver_.solve(solution_);  // Eq. (6)
  v_.head(a_.size()) = solution_;
  if (settings_.projections == Projections::both) {
    phases_.enter(Phase::projection);
    assembly_.project_acceleration(q_, v_, a_, solution_);
    phases_.enter(Phase::solve);
    solver_.solve(solution_);  // Eq. (6)
    a_.swap(solution_);
  }
  phases_.enter(Phase::other);
}

}  // namespace mbs::eigen_dense
