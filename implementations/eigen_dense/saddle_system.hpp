// The linear systems of the saddle-point form: Eqs. (12), (13) and (15).
#pragma once

#include <Eigen/Core>

#include "assembly.hpp"
#include "geometric_stiffness.hpp"
#include "motion.hpp"

namespace mbs::eigen_dense {

/// The same interface as PenaltySystem, with SaddleSolver or SaddleLu for LinearSolver, also
/// Rounded.
template <typename Number, typename LinearSolver, typename Stiffness = NoGeometricStiffness>
class SaddleSystem {
 public:
  using Scalar = Number;
  using Vector = Eigen::VectorX<Scalar>;
  static constexpr bool multipliers_from_Phi = false;

  SaddleSystem(const Model& model, const StepSettings& settings, const Layout& layout)
      : multiplier_factor_(Scalar(4 / (settings.step * settings.step))),
        epsilon_(Scalar(4 / (settings.penalty * settings.step * settings.step))),
        assembly_(model, settings, layout),
        stiffness_(model, settings, layout),
        solver_(model.variables(), model.constraints(), MatrixScalar(epsilon_)),
        upper_(Vector::Zero(model.variables())),
        nu_(Vector::Zero(model.constraints())),
        x_(Vector::Zero(model.variables() + model.constraints())) {
    if (!constant_leading()) return;
    assembly_.leading(solver_.leading());
    solver_.factorize_leading();
  }

  Assembly<Scalar>& assembly() { return assembly_; }

  /// The right-hand side of Eq. (12). C and K are from now on those of this motion.
  void residual(const Motion<Scalar>& motion) {
    assembly_.plain_residual(motion.q, motion.v, motion.a, motion.lambda, upper_);
    x_.head(upper_.size()) = upper_;
    x_.tail(nu_.size()) = -assembly_.Phi();
  }
  /// The matrix of Eq. (12) with the last Jacobian, C and K.
  void assemble(const Vector& lambda) {
    if (!constant_leading()) {
      assembly_.leading(solver_.leading());
      stiffness_.keep(lambda);  // Eq. (16)
      stiffness_.add_tangent(solver_.leading());
    }
    solver_.coupling() = assembly_.jacobian_transposed().template cast<MatrixScalar>();
    assembly_.keep_leading();
  }
  [[nodiscard]] bool factorize() {
    if (!constant_leading()) solver_.factorize_leading();
    return solver_.factorize();
  }

  /// The right-hand sides of Eq. (15); the first of each are those of Eq. (13) for v' − v* and
  /// a' − a*.
  void project_velocity(const Motion<Scalar>& motion) {
    fill_projection(assembly_.velocity_error(motion.v));
  }
  void project_acceleration(const Motion<Scalar>& motion) {
    fill_projection(assembly_.acceleration_error(motion.v, motion.a));
  }
  /// To be called before the first right-hand side of a vector and between the following ones, with
  /// v* − v' or a* − a' in `change` (n).
  void begin_projection() {
    upper_.setZero();
    nu_.setZero();
  }
  void continue_projection(const Vector& change) {
    assembly_.kept_leading_product(change, upper_);
    stiffness_.add_product(change, upper_);
    if (nu_.size() == 0) return;
    nu_ += x_.tail(nu_.size());
    upper_.noalias() -= assembly_.jacobian_transposed() * nu_;
  }

  void solve() { solver_.solve(x_); }
  [[nodiscard]] auto correction() const { return x_.head(upper_.size()); }
  /// The update that belongs to a pass, μ being that of the last solve().
  void update_multipliers(Vector& lambda) const {
    lambda += multiplier_factor_ * x_.tail(lambda.size());
  }

 private:
  using MatrixScalar = typename LinearSolver::Matrix::Scalar;

  [[nodiscard]] bool constant_leading() const {
    return assembly_.constant_leading() && stiffness_.empty();
  }

  void fill_projection(const Vector& error) {
    x_.head(upper_.size()) = upper_;
    x_.tail(nu_.size()) = epsilon_ * nu_ - error;
  }

  Scalar multiplier_factor_;  ///< 4/Δt², 1/s²
  Scalar epsilon_;            ///< ε of Eq. (12)
  Assembly<Scalar> assembly_;
  Stiffness stiffness_;
  LinearSolver solver_;
  Vector upper_;  ///< n; the upper part of a right-hand side
  Vector nu_;     ///< m; ν of a refined projection
  Vector x_;      ///< n + m; right-hand side, then solution
};

/// With the exact tangent.
template <typename Number, typename LinearSolver>
using ExactSaddleSystem = SaddleSystem<Number, LinearSolver, GeometricStiffness<Number>>;

}  // namespace mbs::eigen_dense
