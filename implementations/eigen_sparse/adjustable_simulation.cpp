// Passes and projections of "Other settings".
#include "adjustable_simulation.hpp"

namespace mbs::eigen_sparse {

template <class Form>
AdjustableSimulation<Form>::AdjustableSimulation(const Model& model, const StepSettings& settings)
    : Base(model, settings),
      refined_(settings.tangent != TangentReuse::none || settings.precision == Precision::mixed),
      start_(model.variables()),
      change_(model.variables()),
      violation_(model.constraints()) {
  if (settings.tangent != TangentReuse::none) {
    mechanism_.add_held(model, form_.layout(), settings.step);
  }
}

template <class Form>
void AdjustableSimulation<Form>::do_set_state(const State& state) {
  Base::do_set_state(state);
  factors_due_ = true;
  steps_ = 0;
}

template <class Form>
StepOutcome AdjustableSimulation<Form>::do_step() {
  StepOutcome outcome{StepStatus::pass_limit, 0, 0};
  ++steps_;
  this->predict();
  if (!iterate(outcome) || (refined_ && projected() && !refine(outcome))) {
    outcome.status = StepStatus::factorization_failed;
  }
  if (outcome.status != StepStatus::converged) factors_due_ = true;
  phases_.enter(Phase::other);
  return outcome;
}

/// Passes until convergence; false if a factorization failed.
template <class Form>
bool AdjustableSimulation<Form>::iterate(StepOutcome& outcome) {
  const bool every_pass = settings_.multipliers == MultiplierUpdate::every_pass;
  double previous = 0.0;  // max |delta| of the pass before
  bool previous_converged = false;
  while (!this->passes_end(outcome)) {
    const bool first = ++outcome.passes == 1;
    if (settings_.tangent == TangentReuse::none) factors_due_ = true;
    if (settings_.tangent == TangentReuse::step && first) factors_due_ = true;
    phases_.enter(Phase::evaluation);
    form_.form_residual();
    if (factors_due_ && !factorize(outcome)) return false;
    phases_.enter(Phase::solve);
    form_.solve();  // Eqs. (4), (12)
    const double largest = this->correct();
    const bool converged = largest <= settings_.tolerance;
    if (converged && (every_pass || previous_converged)) outcome.status = StepStatus::converged;
    const bool last = this->passes_end(outcome);
    if (last && projected() && !refined_) this->project();
    if (!last || Form::kUpdatesMultipliers || (projected() && refined_)) this->evaluate();
    if (every_pass || converged) this->update_multipliers();
    if (settings_.tangent == TangentReuse::kept && !first && !converged &&
        !(largest <= 0.25 * previous)) {
      factors_due_ = true;
    }
    previous = largest;
    previous_converged = converged;
  }
  return true;
}

/// The matrix at q'.
template <class Form>
bool AdjustableSimulation<Form>::factorize(StepOutcome& outcome) {
  phases_.enter(Phase::assembly);
  mechanism_.hold(change_);
  form_.refresh();
  phases_.enter(Phase::factorization);
  ++outcome.factorizations;
  factors_due_ = !form_.factorize();
  return !factors_due_;
}

template <class Form>
bool AdjustableSimulation<Form>::projected() const {
  return settings_.projections != Projections::none && steps_ % settings_.projections_every == 0;
}

/// Refined projections; false if a factorization failed.
template <class Form>
bool AdjustableSimulation<Form>::refine(StepOutcome& outcome) {
  const double h = settings_.step, tolerance = settings_.tolerance;
  if (!refine(mechanism_.v, &Mechanism::rates, (2.0 / h) * tolerance, outcome)) return false;
  return settings_.projections == Projections::velocity ||
         refine(mechanism_.a, &Mechanism::accelerations, (4.0 / (h * h)) * tolerance, outcome);
}

/// Eq. (15) for x = v' or a', or the same in the saddle-point form.
template <class Form>
bool AdjustableSimulation<Form>::refine(Vector& x, Terms terms, double tolerance,
                                        StepOutcome& outcome) {
  phases_.enter(Phase::projection);
  (mechanism_.*terms)(terms_);
  start_ = x.head(start_.size());
  form_.start_refinement();
  double previous = 0.0;  // max |delta| of the solve before
  for (int solves = 1; solves <= kMaxRefinements; ++solves) {
    form_refinement(x);
    double largest = solve_refinement();
    if (solves > 1 && !(largest <= 0.5 * previous)) {
      if (settings_.tangent != TangentReuse::kept) break;
      form_refinement(x);  // still with the old C and K
      if (!factorize(outcome)) return false;
      largest = solve_refinement();
    }
    x.head(start_.size()) += form_.delta();
    form_.accept_refinement();
    if (largest <= tolerance) break;
    previous = largest;
  }
  return true;
}

template <class Form>
void AdjustableSimulation<Form>::form_refinement(const Vector& x) {
  phases_.enter(Phase::projection);
  change_ = start_ - x.head(start_.size());
  violation_ = terms_;
  violation_.noalias() += mechanism_.constraints.jacobian() * x.head(start_.size());
  form_.form_refinement(change_, violation_);
}

/// Leaves delta in the form; returns max |delta|.
template <class Form>
double AdjustableSimulation<Form>::solve_refinement() {
  phases_.enter(Phase::solve);
  form_.solve();
  phases_.enter(Phase::projection);
  return largest_of(form_.delta());
}

template class AdjustableSimulation<PenaltyForm<SimplicialSolver<double>>>;
template class AdjustableSimulation<PenaltyForm<SuperluSolver<double>>>;
template class AdjustableSimulation<SaddleForm<SimplicialSolver<double>>>;
template class AdjustableSimulation<SaddleForm<SuperluSolver<double>>>;
template class AdjustableSimulation<PenaltyForm<RoundedSolver<SimplicialSolver>>>;
template class AdjustableSimulation<PenaltyForm<RoundedSolver<SuperluSolver>>>;
template class AdjustableSimulation<SaddleForm<RoundedSolver<SimplicialSolver>>>;
template class AdjustableSimulation<SaddleForm<RoundedSolver<SuperluSolver>>>;

}  // namespace mbs::eigen_sparse
