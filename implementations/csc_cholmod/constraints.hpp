// The numeric part of the constraints: Phi, Phi_q, and the summands of Phi_q^T x and Phi_q^T Phi_q.
#pragma once

#include <vector>

#include "lowering.hpp"
#include "pair_values.hpp"

namespace mbs::csc_cholmod {

/// Refreshed from coordinates through the indices of LoweredConstraints; allocates nothing after
/// construction. Negated copies stand behind the summands, so that a sign is an index: summand i
/// enters with a minus as i + the number of values or products.
class Constraints {
 public:
  /// `lowered` must outlive this.
  explicit Constraints(const LoweredConstraints& lowered);

  /// Takes differences of the coordinates q (all places, m).
  void take(const double* q);
  /// The Jacobian values at the q taken last. Eq. (7)
  void evaluate_jacobian();
  /// Phi (rows) at the q taken last. Eqs. (7), (8)
  void evaluate_phi(const double* q);
  /// result (rows) = Phi-dot at the q taken last, for velocities v (all places) and constant s.
  void first_rate(const double* v, double* result) const;
  /// result (rows) = Phi-double-dot, likewise with accelerations a (all places). Takes v in the
  /// place of q.
  void second_rate(const double* v, const double* a, double* result);
  /// Each Jacobian value times the x (rows) of its row: the summands of Phi_q^T x.
  void multiply(const double* x);
  /// products = factor times each product of two values, then the same negated: the summands of
  /// factor * Phi_q^T Phi_q.
  void multiply_pairs(double factor, double* products) const;

  [[nodiscard]] const double* values() const { return values_.data(); }
  [[nodiscard]] const double* phi() const { return phi_.data(); }
  /// Of multiply(): values, negated values, then the terms of the linear constraints.
  [[nodiscard]] const double* forces() const { return forces_.data(); }
  /// The s of each row; drivers overwrite theirs.
  [[nodiscard]] double* target() { return target_.data(); }

 private:
  const LoweredConstraints& lowered_;
  std::vector<double> target_;
  std::vector<double> phi_;
  std::vector<double> values_;
  std::vector<PairValues> pairs_;
  std::vector<double> forces_;
};

}  // namespace mbs::csc_cholmod
