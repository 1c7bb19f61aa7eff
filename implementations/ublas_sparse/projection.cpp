// The projections that end a step, Eq. (6).
#include "simulation.hpp"  // first: matrices.hpp sets up uBLAS

#include <boost/numeric/ublas/operation.hpp>

namespace mbs::ublas_sparse {

using boost::numeric::ublas::axpy_prod;

template <class Product>
void UblasSimulation<Product>::project_velocity() {  // Eq. (6)
  phases_.enter(Phase::projection);
  constraints_.evaluate_jacobian(points_, matrices_.Phi_q);
  axpy_prod(S(), v_, rhs_, true);
  if (!drivers_.empty()) {
    drivers_.evaluate_rate(points_, weight_);
    add_weighted_rows();
  }
  phases_.enter(Phase::solve);
  solver_.solve(rhs_);
  v_.swap(rhs_);
}

template <class Product>
void UblasSimulation<Product>::project_acceleration() {  // Eq. (6)
  phases_.enter(Phase::projection);
  points_.set_velocity(v_.data());
  constraints_.evaluate_acceleration_term(points_, weight_);
  if (!drivers_.empty()) drivers_.add_acceleration_term(points_, weight_);
  axpy_prod(S(), a_, rhs_, true);
  add_weighted_rows();
  phases_.enter(Phase::solve);
  solver_.solve(rhs_);
  a_.swap(rhs_);
}

template <class Product>
void UblasSimulation<Product>::add_weighted_rows() {
  weight_ *= -scale_ * settings_.penalty;
  axpy_prod(weight_, matrices_.Phi_q, rhs_, false);
}

template void UblasSimulation<ExpressionProduct>::project_velocity();
template void UblasSimulation<ExpressionProduct>::project_acceleration();
template void UblasSimulation<AxpyProduct>::project_velocity();
template void UblasSimulation<AxpyProduct>::project_acceleration();

}  // namespace mbs::ublas_sparse
