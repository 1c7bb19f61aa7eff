// Eqs. (3) to (6) and (15): the linear systems of the penalty form.
#pragma once

#include "assembly.hpp"
#include "mechanism.hpp"
#include "solver.hpp"

namespace mbs::eigen_sparse {

/// Forms right-hand sides at the state of a mechanism and solves with T; SaddleForm offers the
/// same.
template <class Solver_>
class PenaltyForm {
 public:
  using Solver = Solver_;

  /// `mechanism` outlives the form and gets its forces here.
  PenaltyForm(const Model& model, const StepSettings& settings, Mechanism& mechanism, Tuning tuning)
      : quarter_(0.25 * settings.step * settings.step),
        penalty_(settings.penalty),
        mechanism_(mechanism),
        tangent_(model, mechanism.coordinates, mechanism.constraints, Solver::kTriangle,
                 quarter_ * penalty_),
        solver_(tangent_.matrix(), Definiteness::positive, tuning),
        delta_(model.variables()),
        multiplier_(Vector::Zero(model.constraints())) {
    mechanism.add_forces(model, layout(), settings.step);
  }

  [[nodiscard]] Layout layout() const { return tangent_.layout(); }
  /// T at q', with C and K of the last form_residual() or hold().
  void refresh() {
    tangent_.refresh(mechanism_.constraints.jacobian());
    mechanism_.add_to_tangent(tangent_.values());
  }
  [[nodiscard]] bool factorize() { return solver_.factorize(); }

  /// Right-hand side of Eq. (4): -f, Eq. (3) in its form (dt^2/4) (M a' + Phi_q^T (...) - Q).
  void form_residual() {
    multiplier_ = -mechanism_.lambda - penalty_ * mechanism_.constraints.phi();
    mechanism_.unbalanced_force(multiplier_, delta_);
    delta_ *= quarter_;
  }
  /// Right-hand side of Eq. (6) for the change of `x`, v* or a*, with `terms` (m) next to J x.
  void form_projection(const Vector& x, const Vector& terms) {
    mechanism_.constraints.multiply_squared(x, terms, delta_);
    delta_ *= -quarter_ * penalty_;
  }

  /// Begins to refine a projection.
  void start_refinement() {}
  /// Right-hand side of Eq. (15): `change` is v* - v' (n), `violation` Phi_q v' + Phi_t (m).
  void form_refinement(const Vector& change, const Vector& violation) {
    mechanism_.multiply(change, delta_);
    multiplier_ = (-quarter_ * penalty_) * violation;
    delta_.noalias() += mechanism_.constraints.jacobian().transpose() * multiplier_;
  }
  /// Accepts what solve() made of it.
  void accept_refinement() {}

  void solve() { solver_.solve(delta_); }
  /// The solution (n).
  [[nodiscard]] Vector& delta() { return delta_; }

  /// Applies what solve() made of lambda: nothing here.
  void correct_multipliers() {}
  /// lambda after a pass, with Phi at the new q'.
  static constexpr bool kUpdatesMultipliers = true;
  void update_multipliers() {
    mechanism_.lambda += penalty_ * mechanism_.constraints.phi();  // Eq. (1)
  }

 private:
  double quarter_;  // dt^2/4
  double penalty_;
  Mechanism& mechanism_;
  Tangent tangent_;
  Solver solver_;
  Vector delta_;       // n: right-hand sides, overwritten by solutions
  Vector multiplier_;  // m: what Phi_q^T is applied to
};

}  // namespace mbs::eigen_sparse
