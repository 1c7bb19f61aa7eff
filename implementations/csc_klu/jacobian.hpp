// Phi, the Jacobian Phi_q and the products with it, streamed through recorded positions.
#pragma once

#include <array>
#include <vector>

#include "jacobian_pattern.hpp"

namespace mbs::csc_klu {

/// What v and a give of something that is found for both in one sweep.
using Both = std::array<double, 2>;

/// Phi_q in the storage of a JacobianPattern, which has to outlive it.
template <int dim>
class Jacobian {
 public:
  explicit Jacobian(const JacobianPattern<dim>& pattern);

  /// Evaluates Phi (m, written) and Phi_q at the extended positions q.
  void evaluate(const double* q, double* phi);
  /// z (m, written) = Phi_q v and Phi_q a; v and a are n.
  void multiply(const double* v, const double* a, Both* z) const;
  /// y_v, y_a (n, written) = factor Phi_q^T times the v and the a of z (m).
  void multiply_transposed(const Both* z, double factor, double* y_v, double* y_a) const;
  /// y (n) -= Phi_q^T z; z is m.
  void subtract_transposed_product(const double* z, double* y) const;
  /// The same for a z (quadratics()) that is zero for the linear constraints.
  void subtract_transposed_quadratics(const double* z, double* y) const;
  /// z (quadratics(), m^2/s^2) = factor times what the extended velocities v alone give of
  /// Phi-dot_q v + Phi-dot_t.
  void velocity_term(const double* v, double factor, double* z) const;

  /// z (m) += the derivative of Phi when the extended positions q move at the extended rates x:
  /// Phi_q x, and for driven points their share of Phi_t.
  void add_rates(const double* q, const double* x, double* z) const;

  [[nodiscard]] const double* block(int k) const { return values_.data() + dim * k; }

 private:
  const JacobianPattern<dim>& pattern_;
  std::vector<double> values_;  ///< dim values a block, and the spare block
};

}  // namespace mbs::csc_klu
