// The saddle-point form: the matrix of Eq. (12), its right-hand sides, and its solver.
#pragma once

#include <vector>

#include "assembly.hpp"
#include "solver.hpp"

namespace mbs::csc_cholmod {

/// Right-hand sides have the n unknowns in this folder's order, then the rows; solve() takes them
/// into the order of elimination.
class SaddleForm : public Assembly {
 public:
  /// `factorization` must be one without square roots: the matrix has negative pivots.
  SaddleForm(const Model& model, const StepSettings& settings, Method method);

  /// Length of a right-hand side.
  [[nodiscard]] int size() const { return static_cast<int>(place_.size()); }

  /// right = that of Eq. (12).
  void residual(const double* q, const double* u, const double* s, const double* lambda,
                double* right);
  /// Refreshes the matrix at the q of residual(): only values that depend on q are written.
  void refresh_matrix();
  [[nodiscard]] bool factorize() { return solver_.factorize(); }
  /// x (n) = what the matrix \ right has of the unknowns; the rest is kept.
  void solve(const double* right, double* x);
  /// They take mu, before another solve().
  static constexpr bool kMultipliersFromSolution = true;
  /// lambda (rows) += (4/dt^2) mu, with what the last solve() kept.
  void update_multipliers(double* lambda) const;

  /// Eq. (13): right = 0 and minus the rate taken last.
  void projection(double* right) const;

 private:
  SaddleForm(const Model& model, const StepSettings& settings, Method method,
             std::vector<int> place);

  std::vector<int> place_;        ///< n + rows: place in the order of elimination
  HalfPattern pattern_;           ///< in that order
  GatherSchedule schedule_;       ///< of Phi_q, C and K
  std::vector<double> constant_;  ///< on pattern_: M, linear rows, -epsilon
  std::vector<double> matrix_;    ///< on pattern_
  std::vector<double> summands_;  ///< of the matrix, scratch
  std::vector<double> solution_;  ///< n + rows, in the order of elimination
  Solver solver_;
};

}  // namespace mbs::csc_cholmod
