// The trapezoidal schemes with every setting: passes, multipliers, tangent reuse, projections.
#include "newton.hpp"

#include "largest.hpp"
#include "lu_solver.hpp"
#include "penalty_system.hpp"
#include "rounded.hpp"
#include "saddle_lu.hpp"
#include "saddle_solver.hpp"
#include "saddle_system.hpp"
#include "solver.hpp"

namespace mbs::eigen_dense {

namespace {

constexpr int kMostSolutions = 5;

/// Whether Eq. (15) is repeated.
bool refines(const StepSettings& settings) {
  return settings.tangent != TangentReuse::none || settings.precision == Precision::mixed;
}

/// Whether they are at the final q', as in Eq. (15). In single precision the penalty form solves it
/// once: with the one pass a step that float's tolerance asks for, Eq. (6) would drift.
bool projects_at_end(const StepSettings& settings) {
  return refines(settings) ||
         (settings.scheme == Scheme::penalty && settings.precision == Precision::single_precision);
}

}  // namespace

template <typename System>
Newton<System>::Newton(const Model& model, const StepSettings& settings)
    : mbs::Simulation(model, settings),
      settings_(settings),
      refines_(refines(settings)),
      projects_at_end_(projects_at_end(settings)),
      layout_(model),
      system_(model, settings, layout_),
      motion_(model, layout_),
      schedule_(settings.tangent),
      start_(Vector::Zero(model.variables())),
      change_(start_) {}

template <typename System>
void Newton<System>::do_set_state(const State& state) {
  motion_.set(state);
  schedule_.set_state();
  unprojected_ = 0;
}

template <typename System>
StepOutcome Newton<System>::do_step() {
  phases_.enter(Phase::other);
  if (system_.assembly().driven()) system_.assembly().drive(time(), motion_.q, motion_.v);
  motion_.predict(Scalar(settings_.step));
  phases_.enter(Phase::evaluation);
  system_.assembly().evaluate(motion_.q);
  schedule_.begin_step();
  unprojected_ = (unprojected_ + 1) % settings_.projections_every;
  projected_ = unprojected_ == 0 && settings_.projections != Projections::none;
  StepOutcome outcome{StepStatus::pass_limit, 0, 0};
  if (!iterate(outcome)) outcome.status = StepStatus::factorization_failed;
  schedule_.end_step(outcome.status);
  phases_.enter(Phase::other);
  return outcome;
}

template <typename System>
bool Newton<System>::iterate(StepOutcome& outcome) {
  const bool every_pass = settings_.multipliers == MultiplierUpdate::every_pass;
  bool was_small = false;  // of the pass before
  bool last = false;
  while (!last) {
    ++outcome.passes;
    bool small = false;
    if (!pass(outcome, small)) return false;
    if (small && (every_pass || was_small)) outcome.status = StepStatus::converged;
    last = outcome.status == StepStatus::converged || outcome.passes == settings_.max_passes;
    // The projection overwrites the solution; after it only what is still asked for is evaluated.
    if (!System::multipliers_from_Phi) system_.update_multipliers(motion_.lambda);
    if (last && !projects_at_end_ && !project(outcome)) return false;
    phases_.enter(Phase::evaluation);
    const bool jacobian = !last || projects_at_end_;
    if (jacobian || System::multipliers_from_Phi) system_.assembly().evaluate(motion_.q, jacobian);
    phases_.enter(Phase::other);
    if (System::multipliers_from_Phi && (every_pass || small)) {
      system_.update_multipliers(motion_.lambda);
    }
    was_small = small;
  }
  return !projects_at_end_ || project(outcome);
}

template <typename System>
bool Newton<System>::pass(StepOutcome& outcome, bool& small) {
  phases_.enter(Phase::evaluation);
  system_.residual(motion_);
  if (schedule_.due() && !factorize(outcome)) return false;
  phases_.enter(Phase::solve);
  system_.solve();  // Eq. (4) or (12)
  phases_.enter(Phase::other);
  const auto& delta = system_.correction();
  small = motion_.correct(delta.data(), Scalar(settings_.step), Scalar(settings_.tolerance));
  schedule_.after_pass(largest(delta), small);
  return true;
}

template <typename System>
bool Newton<System>::factorize(StepOutcome& outcome) {
  phases_.enter(Phase::assembly);
  system_.assemble(motion_.lambda);
  phases_.enter(Phase::factorization);
  ++outcome.factorizations;
  const bool factorized = system_.factorize();
  if (factorized) schedule_.factorized();
  phases_.enter(Phase::other);
  return factorized;
}

template <typename System>
bool Newton<System>::project(StepOutcome& outcome) {
  if (!projected_) return true;
  const double bound = 2 / settings_.step * settings_.tolerance;
  if (!project(&System::project_velocity, motion_.v, bound, outcome)) return false;
  if (settings_.projections == Projections::velocity) return true;
  return project(&System::project_acceleration, motion_.a, 2 / settings_.step * bound, outcome);
}

template <typename System>
bool Newton<System>::project(MakeRightHandSide make, Vector& target, double tolerance,
                             StepOutcome& outcome) {
  auto x = target.head(motion_.a.size());
  phases_.enter(Phase::projection);
  system_.begin_projection();
  if (!refines_) {
    solve(make);
    x += system_.correction();  // Eq. (6) or (13), or Eq. (15) once
    return true;
  }
  start_ = x;
  double size_before = 0.0;
  for (int k = 1; k <= kMostSolutions; ++k) {
    solve(make);
    double size = largest(system_.correction());
    if (k > 1 && !(size <= size_before / 2)) {  // a NaN is slower, too
      if (!schedule_.keeps()) return true;
      if (!factorize_here(outcome)) return false;
      solve(make);  // the same right-hand side
      size = largest(system_.correction());
    }
    x += system_.correction();  // Eq. (15)
    if (size <= tolerance || k == kMostSolutions) return true;
    size_before = size;
    phases_.enter(Phase::projection);
    change_ = start_ - x;
    system_.continue_projection(change_);
  }
  return true;
}

template <typename System>
void Newton<System>::solve(MakeRightHandSide make) {
  phases_.enter(Phase::projection);
  (system_.*make)(motion_);
  phases_.enter(Phase::solve);
  system_.solve();
}

template <typename System>
bool Newton<System>::factorize_here(StepOutcome& outcome) {
  phases_.enter(Phase::evaluation);
  system_.assembly().scaled_force(motion_.q, motion_.v, change_);  // for C and K alone
  return factorize(outcome);
}

template class Newton<PenaltySystem<double, Solver<double>>>;
template class Newton<PenaltySystem<float, Solver<float>>>;
template class Newton<PenaltySystem<double, Rounded<Solver<float>>>>;
template class Newton<SaddleSystem<double, SaddleSolver<double>>>;
template class Newton<SaddleSystem<float, SaddleSolver<float>>>;
template class Newton<SaddleSystem<double, Rounded<SaddleLu<float>>>>;

template class Newton<ExactPenaltySystem<double, LuSolver<double>>>;
template class Newton<ExactPenaltySystem<float, LuSolver<float>>>;
template class Newton<ExactPenaltySystem<double, Rounded<LuSolver<float>>>>;
template class Newton<ExactSaddleSystem<double, SaddleLu<double>>>;
template class Newton<ExactSaddleSystem<float, SaddleLu<float>>>;
template class Newton<ExactSaddleSystem<double, Rounded<SaddleLu<float>>>>;

}  // namespace mbs::eigen_dense
