// The numeric part of the constraints: Phi, Phi_q, and the summands of Phi_q^T x and Phi_q^T Phi_q.
#pragma once

#include <vector>

#include "lowering.hpp"

namespace mbs::csc_cholmod {

/// Refreshed from coordinates through the indices of LoweredConstraints; allocates nothing after
/// construction. Negated copies stand behind the summands, so that a sign is an index: summand i
/// enters with a minus as i + the number of values or products.
class Constraints {
 public:
  /// `lowered` must outlive this.
  explicit Constraints(const LoweredConstraints& lowered);

  /// The Jacobian values from the coordinates q (all places, m). Eq. (7)
  void evaluate_jacobian(const double* q);
  /// Phi (rows) at the q of the last evaluate_jacobian(). Eqs. (7), (8)
  void evaluate_phi(const double* q);
  /// result (rows) = factor * the part of Phi-double-dot free of a, at velocities v (all places).
  void velocity_terms(const double* v, double factor, double* result);
  /// Each Jacobian value times the x (rows) of its row: the summands of Phi_q^T x.
  void multiply(const double* x);
  /// Factor times each product of two values: the summands of factor * Phi_q^T Phi_q.
  void multiply_pairs(double factor);

  [[nodiscard]] const double* values() const { return values_.data(); }
  [[nodiscard]] const double* phi() const { return phi_.data(); }
  /// Of multiply(): values, negated values, then the terms of the linear constraints.
  [[nodiscard]] const double* forces() const { return forces_.data(); }
  /// Of multiply_pairs(): products, negated products.
  [[nodiscard]] const double* products() const { return products_.data(); }

 private:
  void dot_differences(const double* q);

  const LoweredConstraints& lowered_;
  std::vector<double> phi_;
  std::vector<double> values_;
  std::vector<double> u_, w_;  ///< of the dot block
  std::vector<double> forces_;
  std::vector<double> products_;
};

}  // namespace mbs::csc_cholmod
