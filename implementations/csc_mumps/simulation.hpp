// One time step of paper/README.md, as far as it is the same for both forms of the equations.
#pragma once

#include <memory>
#include <vector>

#include "assembly.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_mumps {

/// A simulation in the form that `settings` ask for. Throws Unsupported if MUMPS cannot be set up
/// for `model`.
std::unique_ptr<Simulation> make_simulation(const Model& model, const StepSettings& settings,
                                            Tuning tuning);

/// Prediction, the loop of passes, the correction, projections. What these solve is up to the form.
class CscMumpsSimulation : public Simulation {
 public:
  /// `unknowns`: order of the form's matrix, n or more.
  CscMumpsSimulation(const Model& model, const StepSettings& settings, int unknowns);

 protected:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  /// Makes x_ begin with Delta q, for the constraints evaluated at q_. False if the matrix cannot
  /// be factorized.
  virtual bool solve_newton() = 0;
  /// After the correction: of what comes with Delta q, and of the constraints evaluated at the new
  /// q_.
  virtual void take_multipliers() {}
  virtual void update_multipliers() {}
  /// Makes x_ begin with the change of v_ or a_ that takes rates_ away, with the factors of the
  /// last pass. False if the solver gave up.
  virtual bool solve_projection() = 0;

  const int variables_;
  const StepSettings settings_;
  const double velocity_factor_;      // 2 / Delta t
  const double acceleration_factor_;  // 4 / Delta t^2
  Assembly assembly_;
  std::vector<double> q_, v_;       // extended; v_ ends in driven velocities, or zeros
  std::vector<double> a_, lambda_;  // n, m
  std::vector<double> rates_;       // m; derivative of Phi by time that a projection takes away
  std::vector<double> x_;           // unknowns; handed to the solver and got back from it

 private:
  void predict();
  void newton_pass(StepOutcome& outcome);
  bool correct();
  bool project();
  bool change(std::vector<double>& x);
};

}  // namespace mbs::csc_mumps
