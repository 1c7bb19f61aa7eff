// What the constraints put into the right-hand sides of the penalty form.
#include "penalty_system.hpp"

#include <algorithm>

#include "elimination_order.hpp"

namespace mbs::csc_umfpack {

template <int D>
PenaltySystem<D>::PenaltySystem(const MassMatrix& mass, const Jacobian<D>& jacobian,
                                const Forces<D>& forces, const StepSettings& settings,
                                Tuning tuning)
    : jacobian_(jacobian),
      forces_(forces),
      penalty_(settings.penalty),
      quarter_(settings.step * settings.step / 4.0),
      factor_(quarter_ * settings.penalty),
      tangent_(mass, jacobian.layout(), forces.layout(), factor_),
      solver_(tangent_.pattern(), tuning,
              tuning == Tuning::trees ? orders_of(tangent_.pattern(), tuning) : Orders()),
      row_factors_(jacobian.layout().rows()) {}

template <int D>
void PenaltySystem<D>::add_constraints(const double* lambda, const double* Phi, double* rhs) {
  const int m = jacobian_.layout().rows();
  for (int row = 0; row < m; ++row) {
    row_factors_[row] = quarter_ * (lambda[row] + penalty_ * Phi[row]);
  }
  jacobian_.subtract_transpose_product(row_factors_.data(), rhs);  // -f, Eq. (3)
}

template <int D>
void PenaltySystem<D>::update_multipliers(const double* Phi, const double*, double* lambda) const {
  const int m = jacobian_.layout().rows();
  for (int row = 0; row < m; ++row) lambda[row] += penalty_ * Phi[row];  // Eq. (1)
}

template <int D>
void PenaltySystem<D>::project(const double* rates, double* rhs) {
  const int m = jacobian_.layout().rows();
  for (int row = 0; row < m; ++row) row_factors_[row] = factor_ * rates[row];
  std::fill_n(rhs, size(), 0.0);
  jacobian_.subtract_transpose_product(row_factors_.data(), rhs);  // Eq. (6)
}

template class PenaltySystem<2>;
template class PenaltySystem<3>;

}  // namespace mbs::csc_umfpack
