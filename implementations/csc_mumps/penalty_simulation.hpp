// The step in the penalty form, Eqs. (3)-(6).
#pragma once

#include <vector>

#include "simulation.hpp"
#include "solver.hpp"
#include "tangent.hpp"

namespace mbs::csc_mumps {

class PenaltySimulation : public CscMumpsSimulation {
 public:
  PenaltySimulation(const Model& model, const StepSettings& settings, Tuning tuning);

 protected:
  bool solve_newton() override;
  void update_multipliers() override;
  bool solve_projection() override;

 private:
  const double reaction_factor_;  // (Delta t^2 / 4) alpha
  Tangent tangent_;
  MultifrontalSolver solver_;
  std::vector<double> weights_;  // m; what the columns of Phi_q are multiplied with
};

}  // namespace mbs::csc_mumps
