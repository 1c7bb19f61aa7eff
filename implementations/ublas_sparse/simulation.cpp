// The step: prediction, passes and projections in terms of uBLAS expressions.
#include "simulation.hpp"

#include <algorithm>
#include <boost/numeric/ublas/matrix.hpp>  // operation.hpp misses it
#include <boost/numeric/ublas/operation.hpp>
#include <cmath>

namespace mbs::ublas_sparse {

using boost::numeric::ublas::axpy_prod;
using boost::numeric::ublas::noalias;

namespace {

Vector to_vector(std::span<const double> values) {
  Vector result(values.size());
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

}  // namespace

template <class Product>
UblasSimulation<Product>::UblasSimulation(const Model& model, const StepSettings& settings)
    : Simulation(model, settings),
      settings_(settings),
      scale_(settings.step * settings.step / 4.0),
      points_(model),
      constraints_(model, points_),
      drivers_(model, points_),
      forces_(model, points_, settings.step),
      M_(mass_matrix(model)),
      S_(forces_.has_stiffness() ? forces_.storage(points_, M_) : SparseMatrix()),
      mass_values_(S_.value_data()),
      matrices_(S(), constraints_.jacobian_storage(points_)),
      solver_(matrices_.T),
      Q_(to_vector(model.force())),
      q_(model.variables()),
      v_(model.variables()),
      a_(model.variables()),
      lambda_(model.constraints()),
      Phi_(model.constraints()),
      weight_(model.constraints()),
      rhs_(model.variables()),
      next_(model.variables()) {}

template <class Product>
void UblasSimulation<Product>::do_set_state(const State& state) {
  std::copy(state.q.begin(), state.q.end(), q_.begin());
  std::copy(state.v.begin(), state.v.end(), v_.begin());
  std::copy(state.a.begin(), state.a.end(), a_.begin());
  std::copy(state.lambda.begin(), state.lambda.end(), lambda_.begin());
}

template <class Product>
void UblasSimulation<Product>::do_get_state(State& state) const {
  std::copy(q_.begin(), q_.end(), state.q.begin());
  std::copy(v_.begin(), v_.end(), state.v.begin());
  std::copy(a_.begin(), a_.end(), state.a.begin());
  std::copy(lambda_.begin(), lambda_.end(), state.lambda.begin());
}

template <class Product>
StepOutcome UblasSimulation<Product>::do_step() {
  if (!drivers_.empty()) drivers_.sample(time(), points_, constraints_);
  predict();
  phases_.enter(Phase::evaluation);
  points_.move_to(q_.data());
  constraints_.evaluate(points_, Phi_);
  StepOutcome outcome{.status = StepStatus::pass_limit, .passes = 0};
  while (outcome.status != StepStatus::converged && outcome.passes < settings_.max_passes) {
    ++outcome.passes;
    evaluate_residual();
    phases_.enter(Phase::assembly);
    assemble_tangent();
    phases_.enter(Phase::factorization);
    if (!solver_.factorize()) {
      phases_.enter(Phase::other);
      return {.status = StepStatus::factorization_failed, .passes = outcome.passes};
    }
    phases_.enter(Phase::solve);
    solver_.solve(rhs_);  // Eq. (4)
    phases_.enter(Phase::other);
    if (update()) outcome.status = StepStatus::converged;
    const bool is_last =
        outcome.status == StepStatus::converged || outcome.passes == settings_.max_passes;
    if (is_last && settings_.projections != Projections::none) project();
    phases_.enter(Phase::evaluation);
    points_.move_to(q_.data());
    constraints_.evaluate(points_, Phi_);
    phases_.enter(Phase::other);
    noalias(lambda_) += settings_.penalty * Phi_;  // Eq. (1)
  }
  phases_.enter(Phase::other);
  return outcome;
}

template <class Product>
void UblasSimulation<Product>::predict() {
  const double dt = settings_.step;
  noalias(next_) = q_ + dt * v_ + (dt * dt / 2.0) * a_;
  noalias(rhs_) = next_ - q_;
  // Element by element, so the left-hand side may stand on the right.
  noalias(a_) = (4.0 / (dt * dt)) * rhs_ - (4.0 / dt) * v_ - a_;  // Eq. (2)
  noalias(v_) = (2.0 / dt) * rhs_ - v_;                           // Eq. (2)
  q_.swap(next_);
}

template <class Product>
void UblasSimulation<Product>::evaluate_residual() {
  constraints_.evaluate_jacobian(points_, matrices_.Phi_q);
  noalias(weight_) = lambda_ + settings_.penalty * Phi_;
  axpy_prod(M_, a_, rhs_, true);
  axpy_prod(weight_, matrices_.Phi_q, rhs_, false);
  if (!drivers_.empty()) drivers_.subtract_force(rhs_);
  if (!forces_.empty()) {
    points_.set_velocity(v_.data());
    forces_.subtract_force(points_, rhs_);
  }
  noalias(rhs_) = scale_ * (Q_ - rhs_);  // -f, Eq. (3)
}

template <class Product>
void UblasSimulation<Product>::assemble_tangent() {
  if (forces_.has_stiffness()) {
    std::copy(mass_values_.begin(), mass_values_.end(), S_.value_data().begin());
    forces_.add_stiffness(points_, S_);
  }
  matrices_.rank_update();
  matrices_.add(S(), scale_ * settings_.penalty);  // Eq. (5)
  solver_.load(matrices_.T);
}

template <class Product>
bool UblasSimulation<Product>::update() {
  const double dt = settings_.step;
  noalias(q_) += rhs_;
  noalias(v_) += (2.0 / dt) * rhs_;                             // Eq. (2)
  noalias(a_) += (4.0 / (dt * dt)) * rhs_;                      // Eq. (2)
  return std::all_of(rhs_.begin(), rhs_.end(), [&](double x) {  // false for a NaN
    return std::abs(x) <= settings_.tolerance;
  });
}

template class UblasSimulation<ExpressionProduct>;
template class UblasSimulation<AxpyProduct>;

}  // namespace mbs::ublas_sparse
