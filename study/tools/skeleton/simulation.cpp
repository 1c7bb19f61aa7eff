// The step of paper/README.md.
#include "simulation.hpp"

namespace mbs::@NAME@ {

Stepper::Stepper(const Model& model, const StepSettings& settings)
    : Simulation(model, settings), model_(model), settings_(settings) {}

void Stepper::do_set_state(const State& state) { state_ = state; }

void Stepper::do_get_state(State& state) const { state = state_; }

StepOutcome Stepper::do_step() {
  // TODO: predict; then passes of residual, tangent, solve until max |Delta q| <= settings_.tolerance, with lambda
  // updated in each; then the projections of v and a, Eq. (6).
  return {StepStatus::pass_limit, 1};
}

void Stepper::evaluate_constraints() {}

void Stepper::evaluate_jacobian() {}

void Stepper::evaluate_residual() {}

void Stepper::evaluate_tangent() {}

bool Stepper::solve(std::vector<double>& /*right*/) { return false; }

}  // namespace mbs::@NAME@
