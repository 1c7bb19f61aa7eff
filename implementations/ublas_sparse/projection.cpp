// The projections that end a step, Eq. (6), solved for what they change.
#include "simulation.hpp"  // first: matrices.hpp sets up uBLAS

#include <boost/numeric/ublas/operation.hpp>

namespace mbs::ublas_sparse {

using boost::numeric::ublas::axpy_prod;
using boost::numeric::ublas::noalias;

namespace {

/// J^T J x (n) by way of J x (m). The C at hand is not for this: its rounding does not lie in the
/// range of J^T, and alpha times it would move x along the directions that constraints leave free.
void multiply_twice(const SparseMatrix& J, const Vector& x, Vector& Jx, Vector& JtJx) {
  axpy_prod(J, x, Jx, true);
  axpy_prod(Jx, J, JtJx, true);
}

}  // namespace

template <class Product>
void UblasSimulation<Product>::project() {
  phases_.enter(Phase::projection);
  SparseMatrix& Phi_q = matrices_.Phi_q;
  const bool both = settings_.projections == Projections::both;
  multiply_twice(Phi_q, v_, weight_, rhs_);
  if (both) multiply_twice(Phi_q, a_, weight_, next_);
  constraints_.evaluate_jacobian(points_, Phi_q);
  if (!drivers_.empty()) {
    drivers_.evaluate_rate(points_, weight_);
    axpy_prod(weight_, Phi_q, rhs_, false);
  }
  correct(rhs_, v_);
  if (!both) return;
  points_.set_velocity(v_.data());
  constraints_.evaluate_acceleration_term(points_, weight_);
  if (!drivers_.empty()) drivers_.add_acceleration_term(points_, weight_);
  axpy_prod(weight_, Phi_q, next_, false);
  correct(next_, a_);
}

template <class Product>
void UblasSimulation<Product>::correct(Vector& right, Vector& x) {
  right *= -scale_ * settings_.penalty;
  phases_.enter(Phase::solve);
  solver_.solve(right);
  phases_.enter(Phase::projection);
  noalias(x) += right;  // Eq. (6)
}

template void UblasSimulation<ExpressionProduct>::project();
template void UblasSimulation<AxpyProduct>::project();

}  // namespace mbs::ublas_sparse
