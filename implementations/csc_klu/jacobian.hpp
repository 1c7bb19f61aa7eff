// Phi, the Jacobian Phi_q and the products with it, streamed through recorded positions.
#pragma once

#include <vector>

#include "jacobian_pattern.hpp"

namespace mbs::csc_klu {

/// Phi_q in the storage of a JacobianPattern, which has to outlive it.
template <int dim>
class Jacobian {
 public:
  explicit Jacobian(const JacobianPattern<dim>& pattern);

  /// Evaluates Phi (m, written) and Phi_q at the extended positions q.
  void evaluate(const double* q, double* phi);
  /// Phi alone.
  void evaluate_phi(const double* q, double* phi);
  /// y (n, written) = factor Phi_q^T z; z is m.
  void multiply_transposed(const double* z, double factor, double* y) const;
  /// y (n) -= factor Phi_q^T z; z is m.
  void subtract_transposed_product(const double* z, double factor, double* y) const;
  /// z (m, written) = the derivative of Phi when the extended positions q move at the extended
  /// velocities v: Phi_q v, and for driven points their share of Phi_t.
  void rates(const double* q, const double* v, double* z) const;
  /// z (m, written) = the second derivative, with the extended accelerations a: Phi_q a, and of
  /// Phi-dot_q v + Phi-dot_t all but driven values.
  void second_rates(const double* q, const double* v, const double* a, double* z) const;
  /// z (m, written) = Phi-dot_q v, for which no driven point may be there.
  void velocity_term(const double* v, double* z) const;

  [[nodiscard]] const double* block(int k) const { return values_.data() + dim * k; }

 private:
  template <bool with_jacobian>
  void sweep(const double* q, double* phi);
  /// y (n, written or added to) = factor Phi_q^T z.
  template <bool adds>
  void sweep_transposed(const double* z, double factor, double* y) const;
  /// The sum of the derivative along x and of the products of velocities v; what is not asked for
  /// is not read.
  template <bool with_rates, bool with_squares>
  void differentiate(const double* q, const double* x, const double* v, double* z) const;

  const JacobianPattern<dim>& pattern_;
  std::vector<double> values_;  ///< dim values a block, and the spare block
};

}  // namespace mbs::csc_klu
