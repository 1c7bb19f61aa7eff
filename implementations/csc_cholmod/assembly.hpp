// The tangent matrix and the right-hand sides, in this folder's order of unknowns and rows.
#pragma once

#include <vector>

#include "constraints.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "gather.hpp"
#include "lowered_forces.hpp"
#include "lowering.hpp"
#include "mass.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "pattern.hpp"

namespace mbs::csc_cholmod {

/// Velocities and accelerations come as lengths, u = (dt/2) v and s = (dt^2/4) a, m: by Eq. (2)
/// they grow by the same Delta q as the coordinates. q and u have all places, s n and a zero.
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

  [[nodiscard]] bool has_drivers() const { return !drivers_.empty(); }
  /// Samples the drivers at time t, for the whole step; writes their places of q and u.
  void drive(double t, double* q, double* u);
  /// Phi and Phi_q at q; every other call works with them.
  void evaluate(const double* q) {
    constraints_.evaluate_jacobian(q);
    constraints_.evaluate_phi(q);
  }
  /// lambda += alpha Phi (rows).
  void update_multipliers(double* lambda) const;
  /// result (n) = -f, Eq. (3).
  void residual(const double* q, const double* u, const double* s, const double* lambda,
                double* result);
  /// Refreshes T, Eq. (5), at the q of residual(): only values that depend on q are written.
  void refresh_tangent();

  /// Eq. (6): velocity (n) is the right-hand side for u.
  void project_velocity(const double* q, const double* u, double* velocity);
  /// Eq. (6): the same; acceleration (n) to be completed once u is known.
  void project_both(const double* q, const double* u, const double* s, double* velocity,
                    double* acceleration);
  /// Eq. (6): acceleration (n) -= (dt^2/4)^2 alpha Phi_q^T (Phi-dot_q v + Phi-dot_t).
  void subtract_velocity_terms(const double* q, const double* u, double* acceleration);

 private:
  void subtract_rates(const double* q, double* velocity);

  double quarter_;  ///< dt^2/4, s^2
  double penalty_;  ///< alpha
  Coordinates coordinates_;
  LoweredConstraints lowered_;
  LoweredForces lowered_forces_;
  HalfPattern pattern_;
  GatherSchedule rows_schedule_;     ///< of Phi_q^T x
  GatherSchedule tangent_schedule_;  ///< of Phi_q^T Phi_q, C and K
  MassMatrix mass_;
  Constraints constraints_;
  Forces forces_;
  std::vector<double> force_;  ///< n, (dt^2/4) Q without force elements
  Drivers drivers_;
  std::vector<double> constant_;  ///< on pattern(): M and the linear constraints' part of T
  std::vector<double> tangent_;   ///< on pattern()
  std::vector<double> products_;  ///< summands of T, scratch
  std::vector<double> row_;       ///< rows, scratch
};

}  // namespace mbs::csc_cholmod
