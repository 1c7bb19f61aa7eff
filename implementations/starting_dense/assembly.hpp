// Right-hand sides and tangent matrix of the step, everything stored dense.
#pragma once

#include "constraints.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "layout.hpp"
#include "matrix.hpp"
#include "mbs/simulation.hpp"

namespace mbs::starting_dense {

/// Holds M and the constant part of Q, and puts them together with constraints, forces and drivers.
/// With n variables and m constraints; coordinates and velocities are extended (see Layout).
class Assembly {
 public:
  /// `model` outlives the assembly.
  Assembly(const Model& model, const StepSettings& settings);

  /// Extended coordinates at t = 0.
  [[nodiscard]] const Vector& extended_position() const { return layout_.position; }

  /// Whether drive() has to be called, once a step.
  [[nodiscard]] bool driven() const { return !drivers_.empty(); }
  /// Takes what is prescribed at time t (s), and writes driven points to q and v.
  void drive(double t, Vector& q, Vector& v) {
    drivers_.sample(t, q, v, constraints_.values(), Q_);
  }

  /// Evaluates phi() and the Jacobian at `q` (m).
  void evaluate(const Vector& q) { constraints_.evaluate(q); }
  /// Phi (m) at the coordinates of the last evaluate().
  [[nodiscard]] const Vector& phi() const { return constraints_.phi(); }
  /// Evaluates the forces of springs and couples, C and K at `q` (m) and `v` (m/s).
  void evaluate_forces(const Vector& q, const Vector& v) { forces_.evaluate(q, v); }

  /// right (n) = M a + Phi_q^T multipliers - Q, with a (n, m/s^2) and multipliers (m, N/m).
  void residual(const Vector& a, const Vector& multipliers, Vector& right);
  /// result (n x n) = M + dt/2 C + dt^2/4 (alpha Phi_q^T Phi_q + K).
  void tangent(Matrix& result);
  /// right (n), of Eq. (6) for v' - v*, with the v* and the Phi_q of tangent().
  void velocity_right(const Vector& v, Vector& right);
  /// The same for a' - a*, with the projected v.
  void acceleration_right(const Vector& v, const Vector& a, Vector& right);

 private:
  /// right (n) = -dt^2/4 alpha Phi_q^T rates_.
  void projection_right(Vector& right);

  const Layout layout_;
  const double factor_;  ///< dt^2/4 alpha
  Matrix M_;
  Vector Q_;  ///< force of the model, and of driven mass
  Constraints constraints_;
  Forces forces_;
  Drivers drivers_;
  Vector product_;  ///< n
  Vector rates_;    ///< derivatives of Phi by time that the projections take away, m
};

}  // namespace mbs::starting_dense
