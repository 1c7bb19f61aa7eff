// The time step on Eigen's sparse matrices, for either solver.
#pragma once

#include "mbs/simulation.hpp"
#include "mechanism.hpp"
#include "penalty_form.hpp"
#ifdef MBS_PARDISO
#include "pardiso_solver.hpp"
#endif
#include "rounded_solver.hpp"
#include "saddle_form.hpp"
#include "solver.hpp"

namespace mbs::eigen_sparse {

/// "The step" with its default settings, in the penalty or in the saddle-point form: every pass
/// factorizes and updates lambda, every step is projected with the last factors.
template <class Form>
class SparseSimulation : public Simulation {
 public:
  SparseSimulation(const Model& model, const StepSettings& settings, Tuning tuning = Tuning::own);

 protected:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  /// Phi_t, or d/dt (Phi_q) v' + d/dt Phi_t.
  using Terms = void (Mechanism::*)(Vector&) const;

  /// Drivers, q', v', a' and the constraints there.
  void predict();
  /// Applies the solution of Eq. (4) or (12); returns max |delta|.
  double correct();
  /// Whether no pass follows, once `outcome` knows of the present one's correction.
  [[nodiscard]] bool passes_end(const StepOutcome& outcome) const;
  /// v' and a' as the settings say, between correct() and evaluate() of the last pass.
  void project();
  void project(Vector& x, Terms terms);
  /// The constraints at the new q'.
  void evaluate();
  void update_multipliers();

  StepSettings settings_;
  Mechanism mechanism_;
  Form form_;
  Vector terms_;  // m: what Phi_q v' or Phi_q a' is added to in a projection
};

extern template class SparseSimulation<PenaltyForm<SimplicialSolver<double>>>;
extern template class SparseSimulation<PenaltyForm<SuperluSolver<double>>>;
#ifdef MBS_PARDISO
extern template class SparseSimulation<PenaltyForm<PardisoSolver>>;
#endif
extern template class SparseSimulation<SaddleForm<SimplicialSolver<double>>>;
extern template class SparseSimulation<SaddleForm<SuperluSolver<double>>>;
extern template class SparseSimulation<PenaltyForm<RoundedSolver<SimplicialSolver>>>;
extern template class SparseSimulation<PenaltyForm<RoundedSolver<SuperluSolver>>>;
extern template class SparseSimulation<SaddleForm<RoundedSolver<SimplicialSolver>>>;
extern template class SparseSimulation<SaddleForm<RoundedSolver<SuperluSolver>>>;

}  // namespace mbs::eigen_sparse
