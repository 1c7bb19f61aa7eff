// The tangent matrix and the right-hand sides, in this folder's order of unknowns and rows.
#pragma once

#include <vector>

#include "constraints.hpp"
#include "gather.hpp"
#include "lowering.hpp"
#include "mass.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "pattern.hpp"

namespace mbs::csc_cholmod {

/// Positions of T = M + (dt^2/4) alpha Phi_q^T Phi_q, lower half, in the model's own order.
HalfPattern tangent_pattern(const Model& model);

/// The part of a tangent matrix that no coordinate changes, on `pattern`: M, extended by zeros.
/// Unknown i of the model is `number[i]` there.
std::vector<double> mass_values(const Model& model, const HalfPattern& pattern,
                                const std::vector<int>& number);
/// values (on `pattern`) += factor * the linear rows' part of Phi_q^T Phi_q.
void add_linear_products(const LinearBlock& linear, const HalfPattern& pattern, double factor,
                         std::vector<double>& values);

/// Symbolic: which summands of Phi_q^T x go into which row, and which products of two Jacobian
/// values into which value of the tangent matrix.
class AssemblySchedule {
 public:
  AssemblySchedule(const LoweredConstraints& lowered, const HalfPattern& pattern);

  [[nodiscard]] const GatherSchedule& rows() const { return rows_; }
  [[nodiscard]] const GatherSchedule& tangent() const { return tangent_; }

 private:
  GatherSchedule rows_;
  GatherSchedule tangent_;
};

/// Numeric. Velocities and accelerations come as lengths, u = (dt/2) v and s = (dt^2/4) a, m: by
/// Eq. (2) they grow by the same Delta q as the coordinates.
class Assembly {
 public:
  /// `pattern`: of T in the model's order. Unknown i of the model becomes `number[i]`, and T is
  /// stored as `half`.
  Assembly(const Model& model, const StepSettings& settings, const HalfPattern& pattern,
           std::vector<int> number, Half half);
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  [[nodiscard]] const Coordinates& coordinates() const { return coordinates_; }
  [[nodiscard]] const LoweredConstraints& constraints() const { return lowered_; }
  [[nodiscard]] const HalfPattern& pattern() const { return pattern_; }
  /// Values of T, aligned with pattern(); the array stays where it is.
  [[nodiscard]] const double* tangent() const { return tangent_.data(); }

  /// Phi and Phi_q at q (all places, m); every other call works with them.
  void evaluate(const double* q) {
    constraints_.evaluate_jacobian(q);
    constraints_.evaluate_phi(q);
  }
  /// lambda += alpha Phi (rows).
  void update_multipliers(double* lambda) const;
  /// result (n) = -f, Eq. (3).
  void residual(const double* s, const double* lambda, double* result);
  /// Refreshes T, Eq. (5): only values that depend on q are written.
  void refresh_tangent();
  /// Eq. (6): velocity = M u*; acceleration = M s*, to be completed once u is known. n each.
  void projections(const double* u, const double* s, double* velocity, double* acceleration) const;
  /// Eq. (6): acceleration (n) -= (dt^2/4)^2 alpha Phi_q^T (Phi-dot_q v), u at all places.
  void subtract_velocity_terms(const double* u, double* acceleration);

 private:
  double quarter_;  ///< dt^2/4, s^2
  double penalty_;  ///< alpha
  Coordinates coordinates_;
  LoweredConstraints lowered_;
  HalfPattern pattern_;
  AssemblySchedule schedule_;
  MassMatrix mass_;
  Constraints constraints_;
  std::vector<double> force_;     ///< n, (dt^2/4) Q
  std::vector<double> constant_;  ///< on pattern(): M and the linear constraints' part of T
  std::vector<double> tangent_;   ///< on pattern()
  std::vector<double> row_;       ///< rows, scratch
};

}  // namespace mbs::csc_cholmod
