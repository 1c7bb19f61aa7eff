// Projections of v and a that end a trapezoidal step: direct, or refined with old factors.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "constraint_rates.hpp"
#include "equations.hpp"
#include "mbs/phase_clock.hpp"
#include "newmark.hpp"
#include "newton_system.hpp"

namespace mbs::csc_klu {

/// What was done about factors that refine too slowly.
enum class Repair {
  none,    ///< nothing: refinement ends
  done,    ///< there are new factors
  failed,  ///< the factorization failed
};

/// Works on x, the v or a of `equations`, with the factors of `system`; both, and `phases`, have to
/// outlive this. What the constraints give comes from `rates`, the member of ConstraintRates with
/// x.
template <int dim, NewtonSystem System>
class Projection {
 public:
  using Rates = std::span<const double> (ConstraintRates<dim>::*)();

  /// `step` is dt, s.
  Projection(double step, const Equations<dim>& equations, System& system, PhaseClock& phases)
      : equations_(equations),
        system_(system),
        phases_(phases),
        rates_(equations),
        stiffness_(equations.force_pattern, step),
        start_(equations.n, 0.0),
        moved_(equations.n, 0.0),
        right_(system.right().size(), 0.0) {}

  /// For refine(): takes note of C and K, whenever they have gone into the matrix.
  void keep_stiffness() {
    if (equations_.has_forces) stiffness_.copy_stiffness(equations_.forces);
  }

  /// Eq. (6) or (13), solved for what it changes of x; q is still that of the matrix.
  void solve(Rates rates, double* x) {
    phases_.enter(Phase::projection);
    const std::span<double> right = system_.right();
    std::fill_n(right.begin(), equations_.n, 0.0);
    system_.include_constraints((rates_.*rates)());
    phases_.enter(Phase::solve);
    system_.solve();
    phases_.enter(Phase::projection);
    for (int i = 0; i < equations_.n; ++i) x[i] += right[i];
  }

  /// Eq. (15) until a correction is not beyond `enough`. Where corrections shrink too slowly,
  /// `repair()` may bring new factors. False if that failed.
  template <class RepairFactors>
  bool refine(Rates rates, double* x, double enough, RepairFactors repair) {
    std::copy_n(x, equations_.n, start_.data());
    system_.reset_reactions();
    double before = 0.0;
    for (int k = 0; k < kMostRefinements; ++k) {
      evaluate_residual(rates, x);
      double size = find_correction();
      if (k > 0 && !(size <= before / 2.0)) {
        const Repair repaired = repair();
        if (repaired != Repair::done) return repaired == Repair::none;
        size = find_correction();
      }
      const double* const correction = system_.right().data();
      for (int i = 0; i < equations_.n; ++i) x[i] += correction[i];  // Eq. (15)
      system_.update_reactions();
      if (size <= enough) return true;
      before = size;
    }
    return true;
  }

 private:
  static constexpr int kMostRefinements = 5;

  /// The right-hand side of Eq. (15), in right_.
  void evaluate_residual(Rates rates, const double* x) {
    phases_.enter(Phase::projection);
    for (int i = 0; i < equations_.n; ++i) moved_[i] = start_[i] - x[i];
    multiply_constant_part(moved_.data());
    system_.include_constraints((rates_.*rates)());
    system_.include_reactions();
    std::ranges::copy(system_.right(), right_.begin());
  }

  /// Solves for the delta of Eq. (15); its largest component.
  double find_correction() {
    std::ranges::copy(right_, system_.right().begin());
    phases_.enter(Phase::solve);
    system_.solve();
    phases_.enter(Phase::projection);
    return largest(equations_.n, system_.right().data());
  }

  /// T_0 x, with C and K of the last matrix, as the first n numbers of the right-hand side.
  void multiply_constant_part(const double* x) {
    equations_.mass.multiply(x, system_.right().data());
    if (equations_.has_forces) stiffness_.add_product(x, system_.right().data());
    system_.include_geometric_stiffness(x);
  }

  const Equations<dim>& equations_;
  System& system_;
  PhaseClock& phases_;
  ConstraintRates<dim> rates_;
  Forces<dim> stiffness_;      ///< for C and K of the last matrix
  std::vector<double> start_;  ///< n; v* or a*
  std::vector<double> moved_;  ///< n; what T_0 multiplies
  std::vector<double> right_;  ///< right-hand side of Eq. (15)
};

}  // namespace mbs::csc_klu
