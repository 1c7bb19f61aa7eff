// The step of paper/README.md: prediction, passes, projections.
#include "simulation.hpp"

namespace mbs::eigen_sparse {

template <class Form>
SparseSimulation<Form>::SparseSimulation(const Model& model, const StepSettings& settings,
                                         Tuning tuning)
    : Simulation(model, settings),
      settings_(settings),
      mechanism_(model, numbered_by(model, Form::Solver::elimination_order, tuning)),
      form_(model, settings, mechanism_, tuning),
      terms_(model.constraints()) {}

template <class Form>
void SparseSimulation<Form>::do_set_state(const State& state) {
  mechanism_.set_state(state);
}

template <class Form>
void SparseSimulation<Form>::do_get_state(State& state) const {
  mechanism_.get_state(state);
}

template <class Form>
StepOutcome SparseSimulation<Form>::do_step() {
  StepOutcome outcome{StepStatus::pass_limit, 0};
  predict();
  while (!passes_end(outcome)) {
    ++outcome.passes;
    phases_.enter(Phase::evaluation);
    form_.form_residual();
    phases_.enter(Phase::assembly);
    form_.refresh();
    phases_.enter(Phase::factorization);
    if (!form_.factorize()) {
      phases_.enter(Phase::other);
      return {StepStatus::factorization_failed, outcome.passes};
    }
    phases_.enter(Phase::solve);
    form_.solve();  // Eqs. (4), (12)
    if (correct() <= settings_.tolerance) outcome.status = StepStatus::converged;
    const bool last = passes_end(outcome);
    if (last) project();
    if (!last || Form::kUpdatesMultipliers) evaluate();
    update_multipliers();
  }
  phases_.enter(Phase::other);
  return outcome;
}

template <class Form>
void SparseSimulation<Form>::predict() {
  Mechanism& m = mechanism_;
  if (m.drivers) m.drivers->sample(time(), m.q, m.v, m.constraints.value(), m.force);
  phases_.enter(Phase::other);
  m.predict(settings_.step, form_.delta());
  evaluate();
}

template <class Form>
double SparseSimulation<Form>::correct() {
  phases_.enter(Phase::other);
  form_.correct_multipliers();
  return mechanism_.correct(settings_.step, form_.delta());
}

template <class Form>
bool SparseSimulation<Form>::passes_end(const StepOutcome& outcome) const {
  return outcome.status == StepStatus::converged || outcome.passes == settings_.max_passes;
}

template <class Form>
void SparseSimulation<Form>::project() {
  if (settings_.projections == Projections::none) return;
  project(mechanism_.v, &Mechanism::rates);
  if (settings_.projections == Projections::both) project(mechanism_.a, &Mechanism::accelerations);
}

/// Eq. (6) or (13) for x = v' or a'.
template <class Form>
void SparseSimulation<Form>::project(Vector& x, Terms terms) {
  phases_.enter(Phase::projection);
  (mechanism_.*terms)(terms_);
  form_.form_projection(x, terms_);
  phases_.enter(Phase::solve);
  form_.solve();
  phases_.enter(Phase::projection);
  x.head(form_.delta().size()) += form_.delta();  // driven points have v alone
}

template <class Form>
void SparseSimulation<Form>::evaluate() {
  phases_.enter(Phase::evaluation);
  mechanism_.evaluate();
}

template <class Form>
void SparseSimulation<Form>::update_multipliers() {
  phases_.enter(Phase::other);
  form_.update_multipliers();
}

template class SparseSimulation<PenaltyForm<SimplicialSolver<double>>>;
template class SparseSimulation<PenaltyForm<SuperluSolver<double>>>;
#ifdef MBS_PARDISO
template class SparseSimulation<PenaltyForm<PardisoSolver>>;
#endif
template class SparseSimulation<SaddleForm<SimplicialSolver<double>>>;
template class SparseSimulation<SaddleForm<SuperluSolver<double>>>;
template class SparseSimulation<PenaltyForm<RoundedSolver<SimplicialSolver>>>;
template class SparseSimulation<PenaltyForm<RoundedSolver<SuperluSolver>>>;
template class SparseSimulation<SaddleForm<RoundedSolver<SimplicialSolver>>>;
template class SparseSimulation<SaddleForm<RoundedSolver<SuperluSolver>>>;

}  // namespace mbs::eigen_sparse
