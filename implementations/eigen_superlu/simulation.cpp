// The step of paper/README.md: prediction, passes, projections.
#include "simulation.hpp"

#include <algorithm>
#include <numeric>

namespace mbs::eigen_superlu {
namespace {

/// The model's unknowns in the order in which `Solver` wants to eliminate them.
template <class Solver>
Coordinates numbered_for(const Model& model) {
  std::vector<int> identity(model.variables());
  std::iota(identity.begin(), identity.end(), 0);
  return {model, Solver::elimination_order(tangent_pattern(model, {model, std::move(identity)}))};
}

}  // namespace

template <class Solver>
SparseSimulation<Solver>::SparseSimulation(const Model& model, const StepSettings& settings)
    : Simulation(model, settings),
      settings_(settings),
      quarter_(0.25 * settings.step * settings.step),
      coordinates_(numbered_for<Solver>(model)),
      assembly_(model, coordinates_, Solver::kTriangle, quarter_ * settings.penalty),
      solver_(assembly_.tangent()),
      mass_(mass_matrix(model, coordinates_)),
      force_(model.variables()),
      q_(Vector::Zero(coordinates_.extended())),
      v_(Vector::Zero(coordinates_.extended())),
      a_(Vector::Zero(model.variables())),
      lambda_(Vector::Zero(model.constraints())),
      delta_(model.variables()),
      multiplier_(Vector::Zero(model.constraints())) {
  coordinates_.gather({model.force().begin(), model.force().end()}, force_);
  const std::vector<double>& fixed = coordinates_.fixed();
  std::copy(fixed.begin(), fixed.end(), q_.data() + model.variables());
  if (!model.driven_points().empty() || !model.driven_values().empty()) {
    drivers_.emplace(model, coordinates_, assembly_.order());
  }
  const ForceSetup setup{model, coordinates_, Solver::kTriangle, assembly_.tangent(),
                         settings.step};
  append_springs(setup, forces_);
  append_torsion_springs(setup, forces_);
  append_couples(setup, forces_);
}

template <class Solver>
void SparseSimulation<Solver>::do_set_state(const State& state) {
  coordinates_.gather(state.q, q_);
  coordinates_.gather(state.v, v_);
  coordinates_.gather(state.a, a_);
  const std::vector<int>& order = assembly_.order();
  for (std::size_t row = 0; row < order.size(); ++row) lambda_[row] = state.lambda[order[row]];
}

template <class Solver>
void SparseSimulation<Solver>::do_get_state(State& state) const {
  coordinates_.scatter(q_, state.q);
  coordinates_.scatter(v_, state.v);
  coordinates_.scatter(a_, state.a);
  const std::vector<int>& order = assembly_.order();
  for (std::size_t row = 0; row < order.size(); ++row) state.lambda[order[row]] = lambda_[row];
}

template <class Solver>
StepOutcome SparseSimulation<Solver>::do_step() {
  StepOutcome outcome{StepStatus::pass_limit, 0};
  if (drivers_) drivers_->sample(time(), q_, v_, assembly_.value(), force_);
  predict();
  while (outcome.status == StepStatus::pass_limit && outcome.passes < settings_.max_passes) {
    ++outcome.passes;
    form_right_hand_side();
    phases_.enter(Phase::assembly);
    assembly_.refresh_tangent();
    for (const auto& force : forces_) force->add_to_tangent(assembly_.tangent_values());
    phases_.enter(Phase::factorization);
    if (!solver_.factorize()) {
      phases_.enter(Phase::other);
      return {StepStatus::factorization_failed, outcome.passes};
    }
    phases_.enter(Phase::solve);
    solver_.solve(delta_);  // Eq. (4)
    if (correct()) outcome.status = StepStatus::converged;
  }
  if (settings_.projections != Projections::none) project_velocities();
  if (settings_.projections == Projections::both) project_accelerations();
  phases_.enter(Phase::other);
  return outcome;
}

template <class Solver>
void SparseSimulation<Solver>::predict() {
  phases_.enter(Phase::other);
  const double h = settings_.step;
  auto q = q_.head(a_.size());
  auto v = v_.head(a_.size());
  delta_ = q;
  q += h * v + (0.5 * h * h) * a_;
  delta_ = q - delta_;
  a_ = (4.0 / (h * h)) * delta_ - (4.0 / h) * v - a_;  // Eq. (2)
  v = (2.0 / h) * delta_ - v;                          // Eq. (2)
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(q_);
}

/// delta = -f, Eq. (3) in its form (dt^2/4) (M a' + Phi_q^T (lambda + alpha Phi) - Q).
template <class Solver>
void SparseSimulation<Solver>::form_right_hand_side() {
  phases_.enter(Phase::evaluation);
  multiplier_ = -lambda_ - settings_.penalty * assembly_.phi();
  delta_ = force_;
  for (const auto& force : forces_) force->apply(q_, v_, delta_);
  delta_.noalias() -= mass_ * a_;
  delta_.noalias() += assembly_.jacobian().transpose() * multiplier_;
  delta_ *= quarter_;
}

/// Applies delta and updates lambda with the new Phi; whether max |delta| is within tolerance.
template <class Solver>
bool SparseSimulation<Solver>::correct() {
  phases_.enter(Phase::other);
  const double h = settings_.step;
  q_.head(a_.size()) += delta_;
  v_.head(a_.size()) += (2.0 / h) * delta_;
  a_ += (4.0 / (h * h)) * delta_;
  const double largest = delta_.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>();
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(q_);
  phases_.enter(Phase::other);
  lambda_ += settings_.penalty * assembly_.phi();  // Eq. (1)
  return largest <= settings_.tolerance;
}

template <class Solver>
void SparseSimulation<Solver>::project_velocities() {
  phases_.enter(Phase::projection);
  delta_.noalias() = mass_ * v_.head(a_.size());
  for (const auto& force : forces_) force->add_product(v_, delta_);
  if (drivers_) {
    multiplier_.setZero();
    drivers_->add_rates(q_, multiplier_);
    multiplier_ *= -quarter_ * settings_.penalty;
    delta_.noalias() += assembly_.jacobian().transpose() * multiplier_;
  }
  phases_.enter(Phase::solve);
  solver_.solve(delta_);  // Eq. (6), velocities
  phases_.enter(Phase::projection);
  v_.head(a_.size()) = delta_;
}

template <class Solver>
void SparseSimulation<Solver>::project_accelerations() {
  assembly_.velocity_terms(v_, multiplier_);
  if (drivers_) drivers_->add_accelerations(q_, multiplier_);
  multiplier_ *= -quarter_ * settings_.penalty;
  delta_.noalias() = mass_ * a_;
  for (const auto& force : forces_) force->add_product(a_, delta_);
  delta_.noalias() += assembly_.jacobian().transpose() * multiplier_;
  phases_.enter(Phase::solve);
  solver_.solve(delta_);  // Eq. (6), accelerations
  a_.swap(delta_);
}

template class SparseSimulation<SimplicialSolver>;
template class SparseSimulation<SuperluSolver>;

}  // namespace mbs::eigen_superlu
