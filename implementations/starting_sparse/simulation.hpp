// The step of paper/README.md on the coordinate-format assembly and MUMPS.
#pragma once

#include <memory>
#include <vector>

#include "assembly.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::starting_sparse {

/// Throws Unsupported for models whose dense Jacobian would be too large.
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings);

class StartingSparseSimulation : public Simulation {
 public:
  StartingSparseSimulation(const Model& model, const StepSettings& settings);

 protected:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

 private:
  void predict();
  [[nodiscard]] bool solve_newton();
  [[nodiscard]] bool advance();
  void evaluate_and_raise_multipliers();
  [[nodiscard]] bool project();
  [[nodiscard]] bool change(std::vector<double>& x);

  StepSettings settings_;
  Assembly assembly_;
  Solver solver_;
  std::vector<double> q_, v_;       // extended by the fixed points, see Assembly
  std::vector<double> a_, lambda_;  // n, m
  std::vector<double> solution_;    // n; right-hand side before, unknowns after a solution
};

}  // namespace mbs::starting_sparse
