// Eqs. (12), (13) and (15): the linear systems of the saddle-point form.
#pragma once

#include "mechanism.hpp"
#include "saddle_solver.hpp"

namespace mbs::eigen_sparse {

/// The same as PenaltyForm with the saddle-point matrix in the place of T.
template <class Solver_>
class SaddleForm {
 public:
  using Solver = Solver_;

  SaddleForm(const Model& model, const StepSettings& settings, Mechanism& mechanism, Tuning tuning)
      : quarter_(0.25 * settings.step * settings.step),
        epsilon_(1.0 / (quarter_ * settings.penalty)),
        mechanism_(mechanism),
        equations_(model, epsilon_, mechanism, stiffness_of(model), tuning),
        delta_(model.variables()),
        multiplier_(model.constraints()),
        nu_(model.constraints()) {
    mechanism.add_forces(model, layout(), settings.step);
  }

  [[nodiscard]] Layout layout() { return equations_.matrix().layout(); }
  /// The matrix at q', with C and K of the last form_residual() or hold().
  void refresh() {
    SaddleMatrix& matrix = equations_.matrix();
    matrix.refresh(mechanism_.constraints.jacobian());
    if (matrix.layout().matrix != nullptr) mechanism_.add_to_tangent(matrix.values());
  }
  [[nodiscard]] bool factorize() { return equations_.factorize(); }

  /// Right-hand side of Eq. (12).
  void form_residual() {
    multiplier_ = -mechanism_.lambda;
    mechanism_.unbalanced_force(multiplier_, delta_);
    delta_ *= quarter_;
    multiplier_ = -mechanism_.constraints.phi();
  }
  /// Right-hand side of Eq. (13) for the change of `x`, v* or a*, with `terms` (m) next to J x.
  void form_projection(const Vector& x, const Vector& terms) {
    delta_.setZero();
    multiplier_ = -terms;
    multiplier_.noalias() -= mechanism_.constraints.jacobian() * x.head(delta_.size());
  }

  /// Begins to refine a projection with nu = 0.
  void start_refinement() { nu_.setZero(); }
  /// Right-hand sides below Eq. (15): `change` is v* - v' (n), `violation` Phi_q v' + Phi_t (m).
  void form_refinement(const Vector& change, const Vector& violation) {
    mechanism_.multiply(change, delta_);
    delta_.noalias() -= mechanism_.constraints.jacobian().transpose() * nu_;
    multiplier_ = epsilon_ * nu_ - violation;
  }
  /// Accepts what solve() made of it.
  void accept_refinement() { nu_ += multiplier_; }

  void solve() { equations_.solve(delta_, multiplier_); }
  /// The solution's first block (n).
  [[nodiscard]] Vector& delta() { return delta_; }

  /// lambda after a pass, with mu of its solve().
  void correct_multipliers() { mechanism_.lambda += (1.0 / quarter_) * multiplier_; }
  /// Phi at the new q' adds nothing to lambda here.
  static constexpr bool kUpdatesMultipliers = false;
  void update_multipliers() {}

 private:
  static Stiffness stiffness_of(const Model& model) {
    return model.springs().empty() && model.torsion_springs().empty() ? Stiffness::none
                                                                      : Stiffness::added;
  }

  double quarter_;  // dt^2/4
  double epsilon_;
  Mechanism& mechanism_;
  SaddleSolver<Solver> equations_;
  Vector delta_;       // n: first blocks of right-hand sides, overwritten by solutions
  Vector multiplier_;  // m: second blocks
  Vector nu_;          // m: of the projection that is being refined
};

}  // namespace mbs::eigen_sparse
