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
  /// lambda (rows) += (4/dt^2) mu, with what the last solve() kept.
  void update_multipliers(double* lambda) const;

  /// Eq. (13): right = 0 and -J x of x = u or s, zero behind the unknowns; with the Phi_q that is
  /// in the matrix, so before evaluate().
  void begin_projection(const double* x, double* right);
  /// Eq. (13): the rows of velocity -= (dt/2) Phi_t.
  void complete_velocity(const double* q, double* velocity);
  /// Eq. (13): the rows of acceleration -= (dt^2/4) (Phi-dot_q v + Phi-dot_t).
  void complete_acceleration(const double* q, const double* u, double* acceleration);

 private:
  SaddleForm(const Model& model, const StepSettings& settings, Method method,
             std::vector<int> number);

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
