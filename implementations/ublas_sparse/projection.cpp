// The projections that end a step, Eq. (6), solved for what they change.
#include <boost/numeric/ublas/operation.hpp>

#include "simulation.hpp"  // first: matrices.hpp sets up uBLAS

namespace mbs::ublas_sparse {

using boost::numeric::ublas::axpy_prod;
using boost::numeric::ublas::noalias;

template <class Product>
void UblasSimulation<Product>::project() {
  phases_.enter(Phase::projection);
  const SparseMatrix& Phi_q = matrices_.Phi_q;  // of the last pass, as points_ are
  axpy_prod(Phi_q, v_, weight_, true);
  if (!drivers_.empty()) drivers_.add_rate(points_, weight_);
  correct(v_);
  if (settings_.projections == Projections::velocity) return;
  points_.set_velocity(v_.data());
  constraints_.evaluate_acceleration_term(points_, weight_);
  if (!drivers_.empty()) drivers_.add_acceleration_term(points_, weight_);
  axpy_prod(Phi_q, a_, weight_, false);
  correct(a_);
}

/// Phi_q^T is multiplied with Phi_q x + ..., in weight_. The C at hand is not for this: its
/// rounding does not lie in the range of Phi_q^T, and alpha times it would move x along the
/// directions that constraints leave free.
template <class Product>
void UblasSimulation<Product>::correct(Vector& x) {
  axpy_prod(weight_, matrices_.Phi_q, rhs_, true);
  rhs_ *= -scale_ * settings_.penalty;
  phases_.enter(Phase::solve);
  solver_.solve(rhs_);
  phases_.enter(Phase::projection);
  noalias(x) += rhs_;  // Eq. (6)
}

template void UblasSimulation<ExpressionProduct>::project();
template void UblasSimulation<AxpyProduct>::project();

}  // namespace mbs::ublas_sparse
