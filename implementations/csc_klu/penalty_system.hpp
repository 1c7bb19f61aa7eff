// Newton's linear system in penalty form: Eqs. (4), (5), (6) and (15).
#pragma once

#include <span>
#include <vector>

#include "equations.hpp"
#include "geometric_stiffness.hpp"
#include "solver.hpp"
#include "tangent.hpp"

namespace mbs::csc_klu {

/// T and a right-hand side of n numbers; see NewtonSystem.
template <int dim, TangentSolver Solver>
class PenaltySystem {
 public:
  static constexpr bool kMultipliersNeedPhi = true;

  PenaltySystem(const Model& model, const StepSettings& settings, Equations<dim>& equations,
                Order order = Order::shallow)
      : penalty_(settings.penalty),
        equations_(equations),
        pattern_(model, equations.jacobian_pattern, equations.force_pattern, order),
        tangent_(pattern_, mass_values(model, pattern_.pattern), equations.weight * penalty_),
        hessians_(needed_hessians(model, settings, equations.jacobian_pattern)),
        geometric_(hessians_, pattern_.pattern, equations.weight),
        right_(equations.n, 0.0),
        solver_(pattern_.pattern, assemble(),
                {geometric_.any() ? Structure::Kind::indefinite : Structure::Kind::definite,
                 pattern_.order}) {}

  std::span<const double> assemble() {
    tangent_.assemble(equations_.jacobian);
    if (equations_.has_forces) tangent_.add(equations_.forces);
    if (geometric_.any()) {
      geometric_.evaluate(penalty_, equations_.lambda, equations_.phi);
      tangent_.add(geometric_);
    }
    return tangent_.values();
  }
  void start_again() { solver_.start_again(); }
  [[nodiscard]] bool factorize() { return solver_.factorize(tangent_.values()); }

  void evaluate_residual() { equations_.evaluate_residual(penalty_, right_.data()); }
  void include_constraints(std::span<const double> rates) {
    equations_.jacobian.subtract_transposed_product(rates.data(), equations_.weight * penalty_,
                                                    right_.data());
  }
  void include_geometric_stiffness(const double* x) { geometric_.add_product(x, right_.data()); }
  void reset_reactions() {}
  void include_reactions() {}
  void update_reactions() {}
  void solve() { solver_.solve(right_); }
  [[nodiscard]] std::span<double> right() { return right_; }

  void take_multipliers() {}
  void update_multipliers() { equations_.update_multipliers(penalty_); }

 private:
  const double penalty_;
  Equations<dim>& equations_;
  const TangentPattern<dim> pattern_;
  Tangent<dim> tangent_;
  const std::vector<HessianEntry> hessians_;
  GeometricStiffness geometric_;  ///< perhaps of nothing
  std::vector<double> right_;     ///< n
  Solver solver_;
};

}  // namespace mbs::csc_klu
