// The step of paper/README.md.
#include "simulation.hpp"

#include <cstddef>

namespace mbs::@NAME@ {

Stepper::Stepper(const Model& model, const StepSettings& settings)
    : Simulation(model, settings), model_(model), settings_(settings) {
  const auto n = static_cast<std::size_t>(model.variables());
  const auto m = static_cast<std::size_t>(model.constraints());
  Phi_.resize(m);
  Phi_q_.resize(m * n);
  f_.resize(n);
  T_.resize(n * n);
}

void Stepper::do_set_state(const State& state) { state_ = state; }

void Stepper::do_get_state(State& state) const { state = state_; }

bool Stepper::do_show_first_pass(FirstPass& pass) {
  predict();
  evaluate_constraints();
  evaluate_jacobian();
  evaluate_residual();
  evaluate_tangent();
  pass = {state_.q, state_.v, state_.a, Phi_, Phi_q_, f_, T_};
  return true;
}

StepOutcome Stepper::do_step() {
  // TODO: predict; then passes of residual, tangent, solve, correct until max |Delta q| <= settings_.tolerance, Phi and
  // Phi_q evaluated anew after each; then project.
  return {StepStatus::pass_limit, 1};
}

void Stepper::predict() {}

void Stepper::evaluate_constraints() {}

void Stepper::evaluate_jacobian() {}

void Stepper::evaluate_residual() {}

void Stepper::evaluate_tangent() {}

// A library may call a NaN in T a success (Eigen's LLT does): look at the solution.
bool Stepper::solve(std::vector<double>& /*right*/) { return false; }

void Stepper::correct(const std::vector<double>& /*delta*/) {}

void Stepper::project() {}

}  // namespace mbs::@NAME@
