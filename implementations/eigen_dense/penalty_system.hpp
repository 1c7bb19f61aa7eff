// The linear systems of the penalty form: Eqs. (4), (6) and (15).
#pragma once

#include <Eigen/Core>
#include <type_traits>

#include "assembly.hpp"
#include "geometric_stiffness.hpp"
#include "motion.hpp"

namespace mbs::eigen_dense {

/// State and residual in Number, matrix and factors in what LinearSolver has: Solver or, with
/// GeometricStiffness for Stiffness, LuSolver, also Rounded.
/// Every method that makes a right-hand side is followed by solve(); correction() is then the part
/// of the solution that belongs to the coordinates. All use the last Assembly::evaluate().
template <typename Number, typename LinearSolver, typename Stiffness = NoGeometricStiffness>
class PenaltySystem {
 public:
  using Scalar = Number;
  using Vector = Eigen::VectorX<Scalar>;
  /// What update_multipliers() needs: the evaluation at the new q', or else the last solve().
  static constexpr bool multipliers_from_Phi = true;

  PenaltySystem(const Model& model, const StepSettings& settings, const Layout& layout)
      : penalty_(Scalar(settings.penalty)),
        assembly_(model, settings, layout),
        stiffness_(model, settings, layout),
        solver_(model.variables()),
        lag_(Vector::Zero(model.variables())),
        x_(lag_) {}

  Assembly<Scalar>& assembly() { return assembly_; }

  /// The right-hand side of Eq. (4). C and K are from now on those of this motion.
  void residual(const Motion<Scalar>& motion) {
    assembly_.residual(motion.q, motion.v, motion.a, motion.lambda, x_);
  }
  /// T of Eq. (5) with the last Phi, Jacobian, C and K.
  void assemble(const Vector& lambda) {
    if constexpr (std::is_same_v<typename LinearSolver::Matrix, Eigen::MatrixX<Scalar>>) {
      assembly_.tangent(solver_.matrix());
    } else {
      assembly_.tangent(solver_.matrix(), jacobian_);
    }
    assembly_.keep_leading();
    stiffness_.keep(lambda + penalty_ * assembly_.Phi());  // Eq. (16)
    stiffness_.add_tangent(solver_.matrix());
  }
  [[nodiscard]] bool factorize() { return solver_.factorize(); }

  /// The right-hand sides of Eq. (15); the first of each are those of Eq. (6) for v' − v* and
  /// a' − a*.
  void project_velocity(const Motion<Scalar>& motion) {
    x_ = lag_;
    assembly_.subtract_penalty(assembly_.velocity_error(motion.v), x_);
  }
  void project_acceleration(const Motion<Scalar>& motion) {
    x_ = lag_;
    assembly_.subtract_penalty(assembly_.acceleration_error(motion.v, motion.a), x_);
  }
  /// To be called before the first right-hand side of a vector and between the following ones, with
  /// v* − v' or a* − a' in `change` (n).
  void begin_projection() { lag_.setZero(); }
  void continue_projection(const Vector& change) {
    assembly_.kept_leading_product(change, lag_);
    stiffness_.add_product(change, lag_);
  }

  void solve() { solver_.solve(x_); }
  [[nodiscard]] const Vector& correction() const { return x_; }
  /// The update that belongs to a pass, Φ being that of the new q'.
  void update_multipliers(Vector& lambda) const {
    lambda += penalty_ * assembly_.Phi();
  }  // Eq. (1)

 private:
  Scalar penalty_;
  Assembly<Scalar> assembly_;
  Stiffness stiffness_;
  LinearSolver solver_;
  Eigen::MatrixXf jacobian_;  ///< Φqᵀ in float, if only the matrix is; else 0×0
  Vector lag_;                ///< n; T₀ times v* − v' or a* − a'
  Vector x_;                  ///< n; right-hand side, then solution
};

/// With the exact tangent.
template <typename Number, typename LinearSolver>
using ExactPenaltySystem = PenaltySystem<Number, LinearSolver, GeometricStiffness<Number>>;

}  // namespace mbs::eigen_dense
