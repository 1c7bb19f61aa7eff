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

  /// The Jacobian values from the coordinates q (all places, m). Eq. (7)
  void evaluate_jacobian(const double* q);
  /// Phi (rows) at the q of the last evaluate_jacobian(). Eqs. (7), (8)
  void evaluate_phi(const double* q);
  /// result (rows) += factor * Phi_q x, at the q of the last evaluate_jacobian(); x (all places) is
  /// zero behind the unknowns. Not after add_velocity_terms(), which takes the place of u and w.
  void add_jacobian_product(const double* x, double factor, double* result) const;
  /// result (rows) += factor * what velocities v (all places) alone give of Phi-double-dot.
  void add_velocity_terms(const double* v, double factor, double* result);
  /// Each Jacobian value times the x (rows) of its row: the summands of Phi_q^T x.
  void multiply(const double* x);
  /// products = factor times each product of two values, then the same negated: the summands of
  /// factor * Phi_q^T Phi_q.
  void multiply_pairs(double factor, double* products) const;
  /// result (n) += x times one row of Phi_q.
  void add_row(int row, double x, double* result) const;

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
