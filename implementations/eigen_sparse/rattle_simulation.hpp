// RATTLE and its compositions of higher order.
#pragma once

#include <vector>

#include "mbs/simulation.hpp"
#include "mechanism.hpp"
#include "saddle_solver.hpp"
#include "solver.hpp"

namespace mbs::eigen_sparse {

/// paper/README.md, "RATTLE". Between steps the solver holds the factors of R(q), Eq. (14).
template <class Solver>
class RattleSimulation final : public Simulation {
 public:
  /// The model has no drivers and no dampers.
  RattleSimulation(const Model& model, const StepSettings& settings);

 private:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  bool advance(double h, StepOutcome& outcome);
  bool find_position(StepOutcome& outcome);
  bool factorize();
  void find_velocity(double h);
  void find_acceleration();
  void solve();

  StepSettings settings_;
  std::vector<double> stages_;  // lengths, s
  Mechanism mechanism_;
  SaddleSolver<Solver> equations_;
  bool factorized_ = false;
  Vector start_;       // n: q of the stage's start, then w
  Vector force_;       // n: Q at q', N
  Vector curvature_;   // m: d/dt (Phi_q) v'
  Vector delta_;       // n: first blocks of right-hand sides, overwritten by solutions
  Vector multiplier_;  // m: second blocks
};

extern template class RattleSimulation<SimplicialSolver<double>>;
extern template class RattleSimulation<SuperluSolver<double>>;

}  // namespace mbs::eigen_sparse
