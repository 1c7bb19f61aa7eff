// The linear system of the saddle-point form: its matrix, factors and right-hand sides.
#include "saddle_point_system.hpp"

#include <algorithm>

namespace mbs::armadillo_dense {

using arma::uword;

SaddlePointSystem::SaddlePointSystem(const Model& model, const StepSettings& settings)
    : Assembly(model, settings),
      epsilon_(4.0 / (settings.penalty * settings.step * settings.step)),
      solver_(n_ + m_),
      rhs_(n_ + m_, arma::fill::zeros),
      multipliers_(rhs_.memptr(), m_, false, true),
      coordinates_(rhs_.memptr() + m_, n_, false, true) {}

void SaddlePointSystem::residual(const arma::vec& x, const arma::vec& v, const arma::vec& a,
                                 const arma::vec& lambda) {
  negative_residual(x, v, a, lambda, coordinates_);  // Eq. (12)
  multipliers_ = -constraints_.phi();
}

void SaddlePointSystem::assemble() {
  arma::mat& A = solver_.matrix();
  const uword n = n_;
  const uword m = m_;
  for (uword i = 0; i < m; ++i) {  // Eq. (12): −ε and Φqᵀ
    double* const column = A.colptr(i);
    column[i] = -epsilon_;
    std::fill(column + i + 1, column + m, 0.0);
    std::copy_n(constraints_.jacobian() + i * uword(layout_.moving), n, column + m);
  }
  for (uword j = 0; j < n; ++j) {  // Eq. (12): T0, which starts as M
    std::copy(M_.colptr(j) + j, M_.colptr(j) + n, A.colptr(m + j) + m + j);
  }
  if (forces_.stiffen()) forces_.add_to(A.colptr(m) + m, A.n_rows);
}

void SaddlePointSystem::velocity_projection(const arma::vec& v) {
  coordinates_.zeros();  // Eq. (13)
  rates(v, multipliers_);
  multipliers_ *= -1.0;
}

void SaddlePointSystem::acceleration_projection(const arma::vec& v, const arma::vec& a) {
  coordinates_.zeros();  // Eq. (13)
  accelerations(v, a, multipliers_);
  multipliers_ *= -1.0;
}

}  // namespace mbs::armadillo_dense
