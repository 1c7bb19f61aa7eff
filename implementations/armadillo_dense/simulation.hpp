// The step over dense matrices.
#pragma once

#include <armadillo>

#include "assembly.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::armadillo_dense {

/// One simulation with a dense tangent matrix: Assembly fills it, CholeskySolver factorizes it in
/// place. All storage is allocated by the constructor.
class DenseSimulation final : public mbs::Simulation {
 public:
  DenseSimulation(const Model& model, const StepSettings& settings);

 private:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  void predict();
  /// Applies Δq (rhs_) to q', v' and a'; whether max|Δq| <= tolerance (false with a NaN).
  [[nodiscard]] bool correct();
  /// Eq. (6) as far as settings ask for it.
  void project();

  StepSettings settings_;
  Assembly assembly_;
  CholeskySolver solver_;
  arma::uword n_, m_;
  arma::vec q_;       ///< extended (see Layout), m
  arma::vec v_;       ///< extended, m/s
  arma::vec a_;       ///< n, m/s²
  arma::vec lambda_;  ///< m
  arma::vec mu_;      ///< m, lambda + alpha Phi
  arma::vec rhs_;     ///< n, right-hand side, then solution
};

}  // namespace mbs::armadillo_dense
