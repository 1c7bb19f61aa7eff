// What IDA solves: our equations in natural coordinates, in one of two forms.
#pragma once

#include "engine.hpp"
#include "equations.hpp"

namespace engines {

/// The unknowns y are q, v, lambda and, in the first form, mu, one after the other:
///   ggl        q' = v - Phi_q^T mu,  M v' = Q - Phi_q^T lambda,  Phi = 0,  Phi_q v = 0
///              (index 2) [Gear, Leimkuhler, Gupta, 1985]
///   baumgarte  q' = v,  M v' = Q - Phi_q^T lambda,  Phi'' + 2 w Phi' + w^2 Phi = 0
///              (index 1) [Baumgarte, 1972]
///
/// [Gear, Leimkuhler, Gupta, 1985] C. W. Gear, B. Leimkuhler, G. K. Gupta, Automatic integration of
/// Euler-Lagrange equations with constraints, J. Comput. Appl. Math. 12-13, 77-90.
/// [Baumgarte, 1972] J. Baumgarte, Stabilization of constraints and integrals of motion in
/// dynamical systems, Comput. Methods Appl. Mech. Eng. 1, 1-16.
class IdaProblem {
 public:
  /// Settings: form, and of the second its rate, w times `duration`.
  IdaProblem(const mbs::Model& model, Settings& settings, double duration);

  [[nodiscard]] std::size_t coordinates() const { return n_; }
  [[nodiscard]] std::size_t size() const { return 2 * n_ + (ggl_ ? 2 : 1) * m_; }

  /// The start, with accelerations and multipliers that fit it.
  void start(double* y, double* y_rate);
  void residual(const double* y, const double* y_rate, double* r);
  /// Where its derivative has entries.
  [[nodiscard]] const SparseWriter& pattern() const { return matrix_; }
  /// The derivative by y plus `c` times that by y', into `values` of the pattern.
  void derivative(const double* y, const double* y_rate, double c, double* values);

 private:
  void take(const double* y, const double* y_rate);
  void write(const double* y, double c);
  void write_start(SparseWriter& to) const;
  const Equations of_;
  const bool ggl_;
  std::size_t n_, m_;
  double w_ = 0.0;  // 1/s

  std::vector<double> q_, v_, a_, sum_;  // extended
  std::vector<double> phi_, rate_, acceleration_;
  SparseWriter matrix_;
};

}  // namespace engines
