// One simulation: the step of paper/README.md in one of the forms of this folder.
#pragma once

#include <vector>

#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_cholmod {

/// `Form` is PenaltyForm or SaddleForm: matrices, right-hand sides and solves.
///
/// Keeps the state in this folder's order. Within a step velocities and accelerations are the
/// lengths u = (dt/2) v and s = (dt^2/4) a, which turns Eq. (2) into
///
///   u' = (q' - q) - u,  s' = (q' - q) - 2 u - s,   and every pass adds Delta q to q', u' and s'.
template <typename Form>
class CholmodSimulation final : public Simulation {
 public:
  CholmodSimulation(const Model& model, const StepSettings& settings, Method method);

 protected:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

 private:
  void predict();
  /// q, u, s grow by Delta q. True if max |Delta q| <= tolerance; NaN is false.
  bool update();
  /// Eqs. (6), (13): after the last correction, before Phi is evaluated at the new q.
  void project();
  /// x (n) += the projection for the rate that form_ took last.
  void correct(std::vector<double>& x);

  StepSettings settings_;
  Form form_;
  // All places for q, u and s (constants and driven points behind the unknowns), else n.
  std::vector<double> q_, v_, a_;
  std::vector<double> u_, s_, delta_;
  std::vector<double> lambda_;  ///< rows
  std::vector<double> right_;   ///< form_.size()
};

}  // namespace mbs::csc_cholmod
