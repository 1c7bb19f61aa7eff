// RATTLE of order two, four and six: stages of Eq. (14).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "assembly.hpp"
#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "motion.hpp"
#include "saddle_solver.hpp"

namespace mbs::eigen_dense {

/// "RATTLE" of paper/README.md, for models without drivers and dampers. Between steps the solver
/// holds R(q) of the state; M, its leading block, is factorized at construction.
template <typename Scalar>
class Rattle final : public mbs::Simulation {
 public:
  using Vector = Eigen::VectorX<Scalar>;

  Rattle(const Model& model, const StepSettings& settings);

 private:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override { motion_.get(state); }

  /// One stage of length h (s). False if the factorization failed.
  [[nodiscard]] bool stage(Scalar h, StepOutcome& outcome);
  void move(Scalar h, StepOutcome& outcome);
  /// Evaluates and factorizes R(q), evaluates Q(q).
  void refresh();
  void find_velocity(Scalar h);
  void find_acceleration();

  /// Solves Eq. (14) with `upper` (n) and −`minus_lower` (m) on the right.
  void solve(const Vector& upper, const Vector& minus_lower);
  [[nodiscard]] auto upper() const { return x_.head(motion_.a.size()); }
  [[nodiscard]] auto lower() const { return x_.tail(motion_.lambda.size()); }

  StepSettings settings_;
  std::vector<Scalar> stages_;  ///< lengths h, s
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
