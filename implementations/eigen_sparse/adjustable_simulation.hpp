// The time step with settings that change when it updates, factorizes and projects.
#pragma once

#include "simulation.hpp"

namespace mbs::eigen_sparse {

/// paper/other_schemes.md, "Other settings".
template <class Form>
class AdjustableSimulation final : public SparseSimulation<Form> {
 public:
  AdjustableSimulation(const Model& model, const StepSettings& settings);

 private:
  using Base = SparseSimulation<Form>;
  using Base::form_, Base::mechanism_, Base::phases_, Base::settings_, Base::terms_;
  using typename Base::Terms;

  void do_set_state(const State& state) override;
  StepOutcome do_step() override;

  bool iterate(StepOutcome& outcome);
  bool factorize(StepOutcome& outcome);
  /// Whether this step is.
  [[nodiscard]] bool projected() const;
  bool refine(StepOutcome& outcome);
  bool refine(Vector& x, Terms terms, double tolerance, StepOutcome& outcome);
  void form_refinement(const Vector& x);
  double solve_refinement();

  bool refined_;
  bool factors_due_ = true;
  long steps_ = 0;    // since set_state()
  Vector start_;      // n: v* or a*
  Vector change_;     // n: v* - v' or a* - a'
  Vector violation_;  // m: the parentheses of Eq. (15)
};

extern template class AdjustableSimulation<PenaltyForm<SimplicialSolver<double>>>;
extern template class AdjustableSimulation<PenaltyForm<SuperluSolver<double>>>;
extern template class AdjustableSimulation<SaddleForm<SimplicialSolver<double>>>;
extern template class AdjustableSimulation<SaddleForm<SuperluSolver<double>>>;
extern template class AdjustableSimulation<PenaltyForm<RoundedSolver<SimplicialSolver>>>;
extern template class AdjustableSimulation<PenaltyForm<RoundedSolver<SuperluSolver>>>;
extern template class AdjustableSimulation<SaddleForm<RoundedSolver<SimplicialSolver>>>;
extern template class AdjustableSimulation<SaddleForm<RoundedSolver<SuperluSolver>>>;

}  // namespace mbs::eigen_sparse
