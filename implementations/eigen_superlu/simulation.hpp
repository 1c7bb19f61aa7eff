// The time step on Eigen's sparse matrices, for either solver.
#pragma once

#include <optional>

#include "assembly.hpp"
#include "coordinates.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::eigen_superlu {

/// All vectors are in the solver's elimination order, rows in the order of Assembly; only get and
/// set translate.
template <class Solver>
class SparseSimulation final : public Simulation {
 public:
  SparseSimulation(const Model& model, const StepSettings& settings);

 private:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  void predict();
  void form_right_hand_side();
  bool correct();
  void project_velocities();
  void project_accelerations();

  StepSettings settings_;
  double quarter_;  // dt^2/4
  Coordinates coordinates_;
  Assembly assembly_;
  Solver solver_;
  RowSparseMatrix mass_;  // both triangles: row products need no scattered stores
  Vector force_;          // the part of Q that holds for a whole step
  std::optional<Drivers> drivers_;
  Forces forces_;  // the rest of Q

  Vector q_, v_;  // extended by fixed points
  Vector a_, lambda_;
  Vector delta_;       // n: right-hand sides, overwritten by solutions
  Vector multiplier_;  // m: what Phi_q^T is applied to
};

extern template class SparseSimulation<SimplicialSolver>;
extern template class SparseSimulation<SuperluSolver>;

}  // namespace mbs::eigen_superlu
