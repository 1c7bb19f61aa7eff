// The symmetric multistep method of order six: Eq. (17).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "rattle_stage.hpp"

namespace mbs::eigen_dense {

/// "Symmetric multistep method" of paper/README.md. The recursion has q, five w and five a; v, a
/// and lambda of the motion are found when they are asked for and do not enter it.
class Multistep final : public mbs::Simulation {
 public:
  Multistep(const Model& model, const StepSettings& settings);

 private:
  using Index = Eigen::Index;

  static constexpr int kHistory = 5;

  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  /// A step of RATTLE. False if a factorization failed; so too the next one.
  [[nodiscard]] bool start(StepOutcome& outcome);
  [[nodiscard]] bool advance(StepOutcome& outcome);

  /// Makes the oldest w and a of the history the new ones.
  void predict();
  /// Adds Δq and its multiple to q', w_n and a_n; whether max|Δq| ≤ tolerance.
  [[nodiscard]] bool correct();
  /// v, a and lambda at q.
  void complete() const;

  /// The column of w_{n−j} and a_{n−j}, j = 0 … 5; the new one replaces that of j = 5.
  [[nodiscard]] Index column(int j) const { return (newest_ + kHistory - j) % kHistory; }

  StepSettings settings_;
  double factor_;                ///< b₀ Δt², s²
  std::vector<double> lengths_;  ///< of the stages of the start, s
  mutable RattleStage<double> stage_;
  mutable bool complete_ = true;  ///< whether v, a and lambda are those of q
  int started_ = 0;               ///< steps of RATTLE since set_state(), up to kHistory
  Index newest_ = 0;              ///< the column that this step fills, or the next one will
  Eigen::MatrixXd w_, a_;         ///< n×5, m and m/s²
  Eigen::VectorXd residual_;      ///< n, kg m; r
};

}  // namespace mbs::eigen_dense
