// Phi, the Jacobian Phi_q and the products with it, streamed through recorded positions.
#pragma once

#include <array>
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
  /// y (n) -= Phi_q^T z; z is m.
  void subtract_transposed_product(const double* z, double* y) const;
  /// The same for a z (dots()) that is zero for the linear constraints.
  void subtract_transposed_dots(const double* z, double* y) const;
  /// z (dots(), m^2/s^2) = factor Phi-dot_q v at the extended velocities v.
  void velocity_term(const double* v, double factor, double* z) const;

  [[nodiscard]] const double* block(int k) const { return values_.data() + dim * k; }

 private:
  using Vector = std::array<double, dim>;

  /// x_a - x_b, two points given by their offsets into x.
  static Vector difference(const double* x, int a, int b) {
    Vector d;
    for (int k = 0; k < dim; ++k) d[k] = x[a + k] - x[b + k];
    return d;
  }
  static double dot(const Vector& x, const Vector& y) {
    double sum = 0.0;
    for (int k = 0; k < dim; ++k) sum += x[k] * y[k];
    return sum;
  }

  const JacobianPattern<dim>& pattern_;
  std::vector<double> values_;  ///< dim values a block, and the spare block
};

}  // namespace mbs::csc_klu
