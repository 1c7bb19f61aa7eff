// Newton's linear system in saddle-point form: Eqs. (12), (13) and, for RATTLE, (14).
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "equations.hpp"
#include "geometric_stiffness.hpp"
#include "saddle_matrix.hpp"
#include "solver.hpp"

namespace mbs::csc_klu {

/// The matrix of Eq. (12) and a right-hand side of n + m numbers; see NewtonSystem.
template <int dim, TangentSolver Solver>
class SaddleSystem {
 public:
  static constexpr bool kMultipliersNeedPhi = false;

  SaddleSystem(const Model& model, const StepSettings& settings, Equations<dim>& equations,
               Order order = Order::shallow)
      : SaddleSystem(model, settings, equations, element_blocks(equations.force_pattern, dim),
                     order) {}

  /// `elements`: those that give C and K; without any, T_0 is M.
  SaddleSystem(const Model& model, const StepSettings& settings, Equations<dim>& equations,
               const std::vector<ElementBlock>& elements, Order order = Order::shallow)
      : equations_(equations),
        has_elements_(!elements.empty()),
        multiplier_factor_(4.0 / (settings.step * settings.step)),
        epsilon_(multiplier_factor_ / settings.penalty),
        hessians_(needed_hessians(model, settings, equations.jacobian_pattern)),
        pattern_(model, equations.jacobian_pattern, elements, hessians_, order),
        geometric_(hessians_, pattern_.pattern, equations.weight),
        scales_(multiplier_scales(model, equations.jacobian_pattern, equations.jacobian)),
        matrix_(pattern_, model, epsilon_, scales_),
        right_(equations.n + equations.m, 0.0),
        nu_(equations.m, 0.0),
        solver_(pattern_.pattern, assemble(),
                Structure{Structure::Kind::indefinite, pattern_.order}) {}

  std::span<const double> assemble() {
    matrix_.assemble(equations_.jacobian);
    if (geometric_.any()) matrix_.reset(geometric_);
    if (has_elements_) matrix_.assemble(equations_.forces);
    if (geometric_.any()) {
      geometric_.evaluate(0.0, equations_.lambda, equations_.phi);
      matrix_.add(geometric_);
    }
    return matrix_.values();
  }
  void start_again() { solver_.start_again(); }
  [[nodiscard]] bool factorize() { return solver_.factorize(matrix_.values()); }

  void evaluate_residual() {
    equations_.evaluate_residual(0.0, right_.data());
    include_constraints(equations_.phi);
  }
  void include_constraints(std::span<const double> rates) {
    double* const lower = right_.data() + equations_.n;
    for (int i = 0; i < equations_.m; ++i) lower[i] = -scales_[i] * rates[i];  // Eqs. (12), (13)
  }
  void include_geometric_stiffness(const double* x) { geometric_.add_product(x, right_.data()); }
  void reset_reactions() { std::ranges::fill(nu_, 0.0); }
  void include_reactions() {
    equations_.jacobian.subtract_transposed_product(nu_.data(), 1.0, right_.data());
    double* const lower = right_.data() + equations_.n;
    for (int i = 0; i < equations_.m; ++i) lower[i] += scales_[i] * epsilon_ * nu_[i];
  }
  void update_reactions() {
    for (int i = 0; i < equations_.m; ++i) nu_[i] += multipliers()[i];
  }
  void solve() {
    solver_.solve(right_);
    double* const lower = right_.data() + equations_.n;
    for (int i = 0; i < equations_.m; ++i) lower[i] *= scales_[i];
  }
  [[nodiscard]] std::span<double> right() { return right_; }
  [[nodiscard]] const double* multipliers() const { return right_.data() + equations_.n; }

  void take_multipliers() {
    const double* const mu = multipliers();
    for (int i = 0; i < equations_.m; ++i) equations_.lambda[i] += multiplier_factor_ * mu[i];
  }
  void update_multipliers() {}

 private:
  Equations<dim>& equations_;
  const bool has_elements_;
  const double multiplier_factor_;  ///< 4/dt^2, 1/s^2
  const double epsilon_;
  const std::vector<HessianEntry> hessians_;
  const SaddlePattern<dim> pattern_;
  GeometricStiffness geometric_;      ///< perhaps of nothing
  const std::vector<double> scales_;  ///< m
  SaddleMatrix<dim> matrix_;
  std::vector<double> right_;  ///< n + m
  std::vector<double> nu_;     ///< m; of a refined projection
  Solver solver_;
};

}  // namespace mbs::csc_klu
