// The penalty form: the tangent matrix of Eq. (5), its right-hand sides, and its solver.
#pragma once

#include <vector>

#include "assembly.hpp"
#include "solver.hpp"

namespace mbs::csc_cholmod {

/// Right-hand sides and solutions have the n unknowns in this folder's order, in which T is
/// factorized too.
class PenaltyForm : public Assembly {
 public:
  PenaltyForm(const Model& model, const StepSettings& settings, Method method);

  /// Length of a right-hand side.
  [[nodiscard]] int size() const { return coordinates_.unknowns(); }

  /// right = -f, Eq. (3).
  void residual(const double* q, const double* u, const double* s, const double* lambda,
                double* right);
  /// Refreshes T, Eq. (5), at the q of residual(): only values that depend on q are written.
  void refresh_matrix();
  [[nodiscard]] bool factorize() { return solver_.factorize(); }
  /// x (n) = T \ right.
  void solve(const double* right, double* x) { solver_.solve(right, x); }
  /// They take Phi at the new q.
  static constexpr bool kMultipliersFromSolution = false;
  /// lambda (rows) += alpha Phi.
  void update_multipliers(double* lambda) const;

  /// Eq. (6): right = -(dt^2/4) alpha Phi_q^T times the rate taken last.
  void projection(double* right);

 private:
  PenaltyForm(const Model& model, const StepSettings& settings, const HalfPattern& pattern,
              Method method);

  double penalty_;                ///< alpha
  HalfPattern pattern_;           ///< of T, in this folder's order
  GatherSchedule schedule_;       ///< of Phi_q^T Phi_q, C and K
  std::vector<double> constant_;  ///< on pattern_: M and the linear constraints' part of T
  std::vector<double> tangent_;   ///< on pattern_: T
  std::vector<double> products_;  ///< summands of T, scratch
  Solver solver_;
};

}  // namespace mbs::csc_cholmod
