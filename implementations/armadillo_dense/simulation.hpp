// The step over dense matrices.
#pragma once

#include <armadillo>

#include "mbs/simulation.hpp"
#include "penalty_system.hpp"
#include "saddle_point_system.hpp"

namespace mbs::armadillo_dense {

/// One simulation with a dense matrix. System is PenaltySystem or SaddlePointSystem: it evaluates
/// the model, makes the linear systems of its scheme and solves them. All storage is allocated by
/// the constructor.
template <class System>
class DenseSimulation final : public mbs::Simulation {
 public:
  DenseSimulation(const Model& model, const StepSettings& settings);

 private:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  void predict();
  /// Applies the solution Δq to q', v' and a'; whether max|Δq| <= tolerance (false with a NaN).
  [[nodiscard]] bool correct();
  /// Eq. (6) or (13) as far as settings ask for it, with Phi_q still that of the last pass.
  void project();

  StepSettings settings_;
  System system_;
  arma::uword n_, m_;
  arma::vec q_;       ///< extended (see Layout), m
  arma::vec v_;       ///< extended, m/s
  arma::vec a_;       ///< extended, m/s²
  arma::vec lambda_;  ///< m
};

extern template class DenseSimulation<PenaltySystem>;
extern template class DenseSimulation<PotrsSystem>;
extern template class DenseSimulation<SaddlePointSystem>;

}  // namespace mbs::armadillo_dense
