// What the equations need of M, the Jacobian and the forces, stored densely.
#pragma once

#include <Eigen/Core>

#include "constraints.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::eigen_dense {

/// Evaluates the equations of paper/README.md for one model, M and the Jacobian being full
/// matrices. With n variables and m constraints; q and v are extended vectors, see Layout.
/// T₀ = M + W, W = (Δt/2) C + (Δt²/4) K; C and K are those of the last scaled_force() or
/// residual().
template <typename Scalar>
class Assembly {
 public:
  using Vector = Eigen::VectorX<Scalar>;
  using Matrix = Eigen::MatrixX<Scalar>;

  Assembly(const Model& model, const StepSettings& settings, const Layout& layout);

  /// Whether drive() has to be called in every step, before all else.
  [[nodiscard]] bool driven() const { return !drivers_.empty() || forces_.driven(); }
  /// Takes the values of drivers and factors at time t (s), puts the driven points into q and v.
  void drive(double t, Vector& q, Vector& v) {
    drivers_.drive(t, q, v);
    forces_.drive(t);
  }

  /// Phi and Phi_q at q (m). All other methods use this Phi_q; Φt and Φ̇t are of this q, too.
  /// Without `jacobian` Phi alone, and nothing else may be called but Phi().
  void evaluate(const Vector& q, bool jacobian = true);

  /// Phi (m) of the last evaluate().
  [[nodiscard]] const Vector& Phi() const { return constraints_.Phi(); }
  /// Φqᵀ (n×m) of the last evaluate().
  [[nodiscard]] auto jacobian_transposed() const { return constraints_.jacobian_transposed(); }

  /// (Δt²/4) Q at q and v into rhs (n, kg m).
  void scaled_force(const Vector& q, const Vector& v, Vector& rhs);

  /// −f of Eq. (3) into rhs (n, kg m), with a' in a (n, m/s²) and lambda (m).
  void residual(const Vector& q, const Vector& v, const Vector& a, const Vector& lambda,
                Vector& rhs);
  /// The same without α Φ: −f₀ of Eq. (12).
  void plain_residual(const Vector& q, const Vector& v, const Vector& a, const Vector& lambda,
                      Vector& rhs);

  /// T of Eq. (5) into the lower triangle of T (n×n, kg); the other half is scratch.
  void tangent(Matrix& T) const;
  /// The same in float, with room for a copy of the Jacobian in `jacobian`.
  void tangent(Eigen::MatrixXf& T, Eigen::MatrixXf& jacobian) const;

  /// M into M (n×n, kg).
  void mass(Matrix& M) const { M = M_; }
  /// M x into y (n), with x of n elements.
  void mass_product(const Eigen::Ref<const Vector>& x, Vector& y) const { y.noalias() = M_ * x; }
  /// Whether T₀ is M always.
  [[nodiscard]] bool constant_leading() const { return !forces_.has_tangent(); }
  /// T₀ of Eq. (12) into the lower triangle of T (n×n, kg); the other half is scratch.
  template <typename MatrixScalar>
  void leading(Eigen::MatrixX<MatrixScalar>& T) const;
  /// Keeps C and K for kept_leading_product().
  void keep_leading() { forces_.keep(); }
  /// T₀ x into y (n), with the C and K of the last keep_leading() and x of n elements.
  void kept_leading_product(const Vector& x, Vector& y) const;

  /// Φq v + Φt (m): by how much v misses its constraints. In a buffer that the next call of any of
  /// these three overwrites.
  const Vector& velocity_error(const Vector& v);
  /// Φ̇q v + Φ̇t (m), likewise.
  const Vector& acceleration_term(const Vector& v);
  /// Φq a + Φ̇q v + Φ̇t (m), likewise.
  const Vector& acceleration_error(const Vector& v, const Vector& a);

  /// rhs (n) −= (Δt²/4) α Φqᵀ error, with error (m) of Eqs. (6) and (15).
  void subtract_penalty(const Vector& error, Vector& rhs) const {
    constraints_.add_transposed_product(-scale_ * penalty_, error, rhs);
  }

 private:
  using Index = Eigen::Index;

  Index variables_;
  Scalar penalty_;
  Scalar scale_;  ///< Δt²/4, s²

  Constraints<Scalar> constraints_;
  Drivers<Scalar> drivers_;
  Forces<Scalar> forces_;

  Matrix M_;             ///< n×n, both triangles, kg
  Matrix M_and_linear_;  ///< M + (Δt²/4) α Φqᵀ Φq of linear constraints; else 0×0
  Vector scaled_force_;  ///< (Δt²/4) Q, its constant part
  Vector multiplier_;    ///< lambda + alpha Phi
  Vector term_;          ///< what the three functions return
};

}  // namespace mbs::eigen_dense
