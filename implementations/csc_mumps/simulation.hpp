// One time step of paper/README.md with compressed sparse columns and a multifrontal solver.
#pragma once

#include <memory>
#include <vector>

#include "assembly.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_mumps {

/// The factory of the registry. Throws Unsupported if MUMPS cannot be set up for `model`.
std::unique_ptr<Simulation> make_simulation(const Model& model, const StepSettings& settings);

class CscMumpsSimulation : public Simulation {
 public:
  CscMumpsSimulation(const Model& model, const StepSettings& settings);

 protected:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

 private:
  /// What one Newton pass came to.
  enum class Pass { converged, unconverged, failed };

  void predict();
  Pass newton_pass();
  bool correct();
  void raise_multipliers();
  bool project();

  const int variables_;
  const StepSettings settings_;
  const double velocity_factor_;      // 2 / Delta t
  const double acceleration_factor_;  // 4 / Delta t^2
  Assembly assembly_;
  MultifrontalSolver solver_;
  std::vector<double> q_, v_;       // extended; v_ ends in driven velocities, or zeros
  std::vector<double> a_, lambda_;  // n, m
  std::vector<double> x_;           // n; handed to the solver and got back from it
};

}  // namespace mbs::csc_mumps
