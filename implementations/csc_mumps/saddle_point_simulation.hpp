// The step in the saddle-point form, Eqs. (12) and (13).
#pragma once

#include "saddle_point_matrix.hpp"
#include "simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_mumps {

class SaddlePointSimulation : public CscMumpsSimulation {
 public:
  SaddlePointSimulation(const Model& model, const StepSettings& settings, Tuning tuning);

 protected:
  bool solve_newton() override;
  void take_multipliers() override;
  bool solve_projection() override;

 private:
  /// Where x_ has what belongs to the constraints.
  [[nodiscard]] double* lower() { return x_.data() + variables_; }

  SaddlePointMatrix matrix_;
  MultifrontalSolver solver_;
};

}  // namespace mbs::csc_mumps
