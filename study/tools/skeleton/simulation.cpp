// The step of paper/README.md.
#include "simulation.hpp"

#include <cstddef>

namespace mbs::@NAME@ {

constexpr std::size_t kMostEntries = (std::size_t{1} << 31) / sizeof(double);

Stepper::Stepper(const Model& model, const StepSettings& settings)
    : Simulation(model, settings), model_(model), settings_(settings) {
  const auto n = static_cast<std::size_t>(model.variables());
  const auto m = static_cast<std::size_t>(model.constraints());
  if (n * n > kMostEntries) throw Unsupported("T would take more than 2 GiB");  // while it is dense
  Phi_.resize(m);
  Phi_q_.resize(m * n);
  f_.resize(n);
  T_.resize(n * n);
  // TODO: M from model.mass(), which lists its lower half alone. Q is model.force(). A fixed point
  // has the offset -1 and no entries in q. There may be no constraint at all, m = 0.
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
  // TODO: predict(), Phi and Phi_q; then passes, settings_.max_passes at most:
  //   residual, tangent, factorize() (false: StepStatus::factorization_failed, at once), solve()
  //   with -f, correct(), Phi and Phi_q anew, lambda += alpha Phi, Eq. (1).
  // The pass with max |Delta q| <= settings_.tolerance is the last; it does all of that too. After
  // the correct() of the last pass, at the limit too, project() what settings_.projections says:
  // nothing, v', or v' and a'. Phi_q is not evaluated anew before that: it has to be the one in T.
  // phases_.enter(Phase::solve);  // optional, for mbs bench --phases: what follows is this
  return {StepStatus::pass_limit, 1};
}

void Stepper::predict() {}

void Stepper::evaluate_constraints() {}

void Stepper::evaluate_jacobian() {}

void Stepper::evaluate_residual() {}

void Stepper::evaluate_tangent() {}

// A library may call a NaN in T a success (Eigen's LLT does): look at the diagonal of the factor.
bool Stepper::factorize() { return false; }

void Stepper::solve(std::vector<double>& /*right*/) {}

void Stepper::correct(const std::vector<double>& /*delta*/) {}

void Stepper::project() {}

}  // namespace mbs::@NAME@
