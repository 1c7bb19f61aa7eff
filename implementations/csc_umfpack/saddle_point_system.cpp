// Right-hand sides and solutions of the saddle-point form.
#include "saddle_point_system.hpp"

#include <algorithm>

namespace mbs::csc_umfpack {

template <int D>
SaddlePointSystem<D>::SaddlePointSystem(const MassMatrix& mass, const Jacobian<D>& jacobian,
                                        const Forces<D>& forces, const StepSettings& settings,
                                        Tuning tuning)
    : jacobian_(jacobian),
      forces_(forces),
      n_(mass.pattern().variables()),
      m_(jacobian.layout().rows()),
      quarter_(settings.step * settings.step / 4.0),
      matrix_(mass, jacobian.layout(), forces.layout(), 1.0 / (quarter_ * settings.penalty),
              tuning),
      solver_(matrix_.pattern(), tuning, matrix_.orders()),
      row_factors_(m_) {}

template <int D>
void SaddlePointSystem<D>::add_constraints(const double* lambda, const double* Phi, double* rhs) {
  for (int row = 0; row < m_; ++row) {
    row_factors_[row] = quarter_ * lambda[row];
    rhs[n_ + row] = -Phi[row];  // Eq. (12)
  }
  jacobian_.subtract_transpose_product(row_factors_.data(), rhs);  // -f_0, Eq. (12)
}

template <int D>
void SaddlePointSystem<D>::update_multipliers(const double*, const double* solution,
                                              double* lambda) const {
  const double* mu = solution + n_;
  for (int row = 0; row < m_; ++row) lambda[row] += mu[row] / quarter_;
}

template <int D>
void SaddlePointSystem<D>::project(const double* rates, double* rhs) const {
  std::fill_n(rhs, n_, 0.0);
  for (int row = 0; row < m_; ++row) rhs[n_ + row] = -rates[row];  // Eq. (13)
}

template class SaddlePointSystem<2>;
template class SaddlePointSystem<3>;

}  // namespace mbs::csc_umfpack
