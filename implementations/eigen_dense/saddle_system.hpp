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

  SaddleSystem(const Model& model, const StepSettings& settings, const Layout& layout)
      : multiplier_factor_(Scalar(4 / (settings.step * settings.step))),
        epsilon_(Scalar(4 / (settings.penalty * settings.step * settings.step))),
        assembly_(model, settings, layout),
        stiffness_(model, settings, layout),
        solver_(model.variables(), model.constraints(), MatrixScalar(epsilon_)),
        upper_(Vector::Zero(model.variables())),
        nu_(Vector::Zero(model.constraints())),
        velocity_rate_(nu_),
        acceleration_rate_(nu_),
        x_(Vector::Zero(model.variables() + model.constraints())) {
    if (!constant_leading()) return;
    assembly_.leading(solver_.leading());
    solver_.factorize_leading();
  }

  Assembly<Scalar>& assembly() { return assembly_; }

  /// The right-hand side of Eq. (12). C and K are from now on those of this motion.
  void residual(const Motion<Scalar>& motion) {
    assembly_.plain_residual(motion.q, motion.v, motion.a, motion.lambda, upper_);
    fill(assembly_.Phi());
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

  /// To be called before the evaluation at the final q', with v* and a*: the Jacobian is still that
  /// of the last pass.
  void start_projections(const Motion<Scalar>& motion) {
    assembly_.jacobian_product(motion.v, velocity_rate_);
    assembly_.jacobian_product(motion.a, acceleration_rate_);
    upper_.setZero();
  }
  /// The right-hand sides of Eq. (13) for v' − v*, then for a' − a* with that v'.
  void project_velocity(const Motion<Scalar>& motion) {
    velocity_rate_ += assembly_.velocity_term(motion.q);
    fill(velocity_rate_);
  }
  void project_acceleration(const Motion<Scalar>& motion) {
    acceleration_rate_ += assembly_.acceleration_term(motion.q, motion.v);
    fill(acceleration_rate_);
  }

  /// Those of Eq. (15).
  void refine_velocity(const Motion<Scalar>& motion) {
    fill_refinement(assembly_.velocity_error(motion.q, motion.v));
  }
  void refine_acceleration(const Motion<Scalar>& motion) {
    fill_refinement(assembly_.acceleration_error(motion.q, motion.v, motion.a));
  }
  /// To be called before the first refinement of a vector and between the following ones, with
  /// v* − v' or a* − a' in `change` (n).
  void begin_refinement() {
    upper_.setZero();
    nu_.setZero();
  }
  void continue_refinement(const Vector& change) {
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

  void fill(const Vector& minus_lower) {
    x_.head(upper_.size()) = upper_;
    x_.tail(minus_lower.size()) = -minus_lower;
  }

  void fill_refinement(const Vector& error) {
    fill(error);
    x_.tail(nu_.size()) += epsilon_ * nu_;
  }

  Scalar multiplier_factor_;  ///< 4/Δt², 1/s²
  Scalar epsilon_;            ///< ε of Eq. (12)
  Assembly<Scalar> assembly_;
  Stiffness stiffness_;
  LinearSolver solver_;
  Vector upper_;                              ///< n; the upper part of a right-hand side
  Vector nu_;                                 ///< m; ν of a refined projection
  Vector velocity_rate_, acceleration_rate_;  ///< m; J v* and J a*, then with the other terms
  Vector x_;                                  ///< n + m; right-hand side, then solution
};

/// With the exact tangent.
template <typename Number, typename LinearSolver>
using ExactSaddleSystem = SaddleSystem<Number, LinearSolver, GeometricStiffness<Number>>;

}  // namespace mbs::eigen_dense
