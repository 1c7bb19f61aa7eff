// One stage of RATTLE: Eq. (14).
#pragma once

#include <Eigen/Core>

#include "assembly.hpp"
#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "motion.hpp"
#include "saddle_solver.hpp"

namespace mbs::eigen_dense {

/// The motion of a model without drivers and dampers, what advances it by a stage of
/// paper/README.md, "RATTLE", and the linear system for that. M, its leading block, is factorized
/// at construction.
template <typename Scalar>
class RattleStage {
 public:
  using Vector = Eigen::VectorX<Scalar>;

  /// Books its phases on `phases` and leaves them at `other`.
  RattleStage(const Model& model, const StepSettings& settings, PhaseClock& phases);

  /// Starts from q and v of `state`.
  void set(const State& state);

  /// One stage of length h (s), from a motion whose R(q) is factorized to another one. False if the
  /// factorization failed.
  [[nodiscard]] bool advance(Scalar h, StepOutcome& outcome);
  /// q' − q (n, m) of the last stage.
  [[nodiscard]] const Vector& change() const { return change_; }

  Motion<Scalar>& motion() { return motion_; }
  [[nodiscard]] const Motion<Scalar>& motion() const { return motion_; }
  Assembly<Scalar>& assembly() { return assembly_; }

  /// Evaluates and factorizes R(q), evaluates Q(q). False if the factorization failed.
  bool refresh();
  /// Q (n, N) of the last refresh().
  [[nodiscard]] const Vector& force() const { return force_; }
  /// The refinement of v, then a and lambda, after a refresh() at the same q.
  void refine_velocity();
  void find_acceleration();

  /// Solves the refreshed Eq. (14) with `upper` (n) and −`minus_lower` (m) on the right. The part
  /// of the solution that belongs to the coordinates is upper().
  void solve(const Vector& upper, const Vector& minus_lower);
  [[nodiscard]] auto upper() const { return x_.head(motion_.a.size()); }
  /// n zeros.
  [[nodiscard]] const Vector& zero() const { return zero_; }

 private:
  void move(Scalar h, StepOutcome& outcome);
  void find_velocity(Scalar h);
  [[nodiscard]] auto lower() const { return x_.tail(motion_.lambda.size()); }

  StepSettings settings_;
  PhaseClock& phases_;
  Layout layout_;
  Assembly<Scalar> assembly_;
  SaddleSolver<Scalar> solver_;
  Motion<Scalar> motion_;
  bool factorized_ = false;
  Vector zero_;     ///< n
  Vector start_;    ///< n, m; q at the start of a stage
  Vector change_;   ///< n, m; q' − q
  Vector force_;    ///< n, N; Q
  Vector impulse_;  ///< n, N s; (h/2) Q
  Vector x_;        ///< n + m; right-hand side, then solution
};

}  // namespace mbs::eigen_dense
