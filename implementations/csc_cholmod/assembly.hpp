// What both forms of a step share: the model in this folder's order, Phi, Phi_q, M, forces.
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
/// they grow by the same Delta q as the coordinates. q, u and s have all places.
class Assembly {
 public:
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  [[nodiscard]] const Coordinates& coordinates() const { return coordinates_; }
  [[nodiscard]] const LoweredConstraints& constraints() const { return lowered_; }

  [[nodiscard]] bool has_drivers() const { return !drivers_.empty() || forces_.is_driven(); }
  /// Samples the drivers and factors of laws at time t, for the whole step; writes their places of
  /// q, u and s.
  void drive(double t, double* q, double* u, double* s);
  /// Phi at q; every other call works at this q.
  void evaluate(const double* q) {
    constraints_.take(q);
    constraints_.evaluate_phi(q);
  }
  /// Eqs. (6), (13): row_ = (dt/2) (Phi_q v + Phi_t), with the Phi_q in the matrix.
  void take_first_rate(const double* u);
  /// Likewise row_ = (dt^2/4) (Phi_q a + Phi-dot_q v + Phi-dot_t), once before evaluate().
  void take_second_rate(const double* u, const double* s);

 protected:
  /// Unknown i of the model becomes `number[i]`, and M is stored as `half`.
  Assembly(const Model& model, const StepSettings& settings, std::vector<int> number, Half half);
  ~Assembly() = default;

  /// result (n) = (dt^2/4) Q - M s + Phi_q^T row_; takes Phi_q, and the force elements at q and u.
  void balance(const double* q, const double* u, const double* s, double* result);
  /// result (n) += Phi_q^T row_.
  void add_row_forces(double* result);

  double quarter_;  ///< dt^2/4, s^2
  Coordinates coordinates_;
  LoweredConstraints lowered_;
  LoweredForces lowered_forces_;
  GatherSchedule rows_schedule_;  ///< of Phi_q^T x
  MassMatrix mass_;
  Constraints constraints_;
  Forces forces_;
  std::vector<double> force_;  ///< n, (dt^2/4) Q without force elements
  Drivers drivers_;
  std::vector<double> row_;  ///< rows, scratch
};

}  // namespace mbs::csc_cholmod
