// The trapezoidal schemes with every setting: passes, multipliers, tangent reuse, projections.
#pragma once

#include <Eigen/Core>

#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "motion.hpp"
#include "tangent_schedule.hpp"

namespace mbs::eigen_dense {

/// "The step" of paper/README.md with "Other settings" of paper/other_schemes.md over the linear
/// systems of System, which is PenaltySystem or SaddleSystem.
template <typename System>
class Newton final : public mbs::Simulation {
 public:
  Newton(const Model& model, const StepSettings& settings);

 private:
  using Scalar = typename System::Scalar;
  using Vector = Eigen::VectorX<Scalar>;
  using MakeRightHandSide = void (System::*)(const Motion<Scalar>&);

  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override { motion_.get(state); }

  // All false: a factorization failed.
  [[nodiscard]] bool factorize(StepOutcome& outcome);
  /// The same at the final q', where C and K have not been evaluated yet; overwrites change_.
  [[nodiscard]] bool factorize_here(StepOutcome& outcome);
  /// The passes of a step and its projections; sets the outcome's status and counts.
  [[nodiscard]] bool iterate(StepOutcome& outcome);
  /// One pass up to the correction of the motion. Leaves the phase at `other`; `small` says whether
  /// max|Δq| is within the tolerance.
  [[nodiscard]] bool pass(StepOutcome& outcome, bool& small);
  [[nodiscard]] bool project(StepOutcome& outcome);
  /// Projects v or a, as `make` asks for. A refinement goes on until max|δ| ≤ tolerance.
  [[nodiscard]] bool project(MakeRightHandSide make, Vector& target, double tolerance,
                             StepOutcome& outcome);

  /// Makes a right-hand side and solves. Leaves the phase at `solve`.
  void solve(MakeRightHandSide make);

  StepSettings settings_;
  bool refines_;          ///< repeats Eq. (15)
  bool projects_at_end_;  ///< after the evaluation at the final q'; else before it
  Layout layout_;
  System system_;
  Motion<Scalar> motion_;
  TangentSchedule schedule_;
  Vector start_, change_;   ///< n; v* or a* of a refinement, v* − v' or a* − a'
  int unprojected_ = 0;     ///< steps since the last one that was due to be projected
  bool projected_ = false;  ///< whether this step is
};

}  // namespace mbs::eigen_dense
