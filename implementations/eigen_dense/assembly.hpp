// The residual, the tangent matrix and the right-hand sides of the projections, stored densely.
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
class Assembly {
 public:
  Assembly(const Model& model, const StepSettings& settings, const Layout& layout);

  /// Whether drive() has to be called in every step, before all else.
  [[nodiscard]] bool driven() const { return !drivers_.empty(); }
  /// Takes the drivers' values at time t (s) and puts the driven points into q and v.
  void drive(double t, Eigen::VectorXd& q, Eigen::VectorXd& v) { drivers_.drive(t, q, v); }

  /// Phi and Phi_q at q (m). All other methods use this Phi_q.
  void evaluate(const Eigen::VectorXd& q);

  /// Phi (m) of the last evaluate().
  [[nodiscard]] const Eigen::VectorXd& Phi() const { return constraints_.Phi(); }

  /// −f of Eq. (3) into rhs (n, kg m), with a' in a (n, m/s²) and lambda (m). C and K are from now
  /// on those of this q and v.
  void residual(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                const Eigen::VectorXd& lambda, Eigen::VectorXd& rhs);

  /// T of Eq. (5) into the lower triangle of T (n×n, kg); the other half is scratch.
  void tangent(Eigen::MatrixXd& T) const;

  /// The right-hand side of Eq. (6) for v' into rhs (n), with v* in v.
  void project_velocity(const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& rhs);

  /// The right-hand side of Eq. (6) for a' into rhs (n), with the projected v' and a* in a (n).
  void project_acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                            const Eigen::VectorXd& a, Eigen::VectorXd& rhs);

 private:
  using Index = Eigen::Index;

  Index variables_;
  double penalty_;
  double scale_;       ///< Δt²/4, s²
  Index slice_depth_;  ///< columns that one rank-k update takes, see tangent()

  Constraints constraints_;
  Drivers drivers_;
  Forces forces_;

  Eigen::MatrixXd M_;             ///< n×n, both triangles, kg
  Eigen::MatrixXd M_and_linear_;  ///< M + (Δt²/4) α Φqᵀ Φq of linear constraints; else 0×0
  Eigen::VectorXd scaled_force_;  ///< (Δt²/4) Q, its constant part
  Eigen::VectorXd multiplier_;    ///< lambda + alpha Phi
  Eigen::VectorXd acceleration_term_;  ///< Φ̇q v + Φ̇t, and Φt before that
};

}  // namespace mbs::eigen_dense
