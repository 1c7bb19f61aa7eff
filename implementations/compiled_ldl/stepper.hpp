// One simulation: the step of paper/README.md in every scheme and setting.
#pragma once

#include <memory>

#include "history.hpp"
#include "mbs/simulation.hpp"
#include "system.hpp"

namespace mbs::compiled_ldl {

template <typename S, typename F, int D>
class Stepper final : public Simulation {
 public:
  Stepper(const Model& model, const StepSettings& settings);

 protected:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

 private:
  // passes.hpp
  StepOutcome trapezoidal_step();
  void predict();
  bool run_passes(StepOutcome& outcome);
  bool factorizes(int pass) const;
  bool solve_pass(StepOutcome& outcome);
  S apply_pass();
  void judge_factors(int pass, S change, S previous);
  // projections.hpp
  bool project(StepOutcome& outcome);
  void project_saddle(S* x, const S* terms);
  void project_penalty(S* x, const S* v);
  bool refine(S* x, const S* given, bool of_velocity, StepOutcome& outcome);
  S take_correction();
  bool renew_factors();
  void refinement_residual(const S* x, const S* given, bool of_velocity);
  const S* without_fixed(const S* x);
  // rattle.hpp
  StepOutcome rattle_step();
  bool stage(S length, StepOutcome& outcome);
  bool move(S length, StepOutcome& outcome);
  void find_acceleration();
  void refine_velocity();
  void refine_acceleration();
  void solve_constraints(const S* errors);
  // multistep.hpp
  StepOutcome multistep_step();
  StepOutcome recur();
  void apply_to_history(S to_a);
  void complete();

  static constexpr bool kDouble = std::is_same_v<S, double> && std::is_same_v<F, double>;

  StepSettings settings_;
  System<S, F, D> system_;
  bool reuses_, refines_;
  S step_, tolerance_;
  bool due_ = true;              // factors are to be renewed
  int unprojected_ = 0;          // steps since the last projection
  Array<S> velocity_terms_;      // of constraints: Φt or Φ̇q v' + Φ̇t
  Array<S> star_, multipliers_;  // refinement: v* or a*, ν
  Array<S> difference_;          // coordinates, zero at fixed points
  Array<S> right_hand_side_;
  std::unique_ptr<History> history_;  // of the multistep method
  bool is_complete_ = true;           // v, a and λ are those of q
};

}  // namespace mbs::compiled_ldl

#include "multistep.hpp"
#include "passes.hpp"
#include "projections.hpp"
#include "rattle.hpp"
