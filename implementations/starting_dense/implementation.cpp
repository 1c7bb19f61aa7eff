// Describes starting_dense to the harness.
#include "mbs/implementation.hpp"

#include "simulation.hpp"

namespace mbs::starting_dense {

namespace {

std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return std::make_unique<DenseSimulation>(model, settings);
}

}  // namespace

Implementation implementation() {
  return {
      .description = "the paper's starting point: all dense, plain loops, general LU solver",
      .library = "LAPACK",
      .version = Solver::version(),
      .licence = "BSD-3-Clause",
      .variants = {{.name = "gesv",
                    .description = "LU with partial pivoting of DGESV, factors kept",
                    .create = create,
                    .dense = true,
                    .unsymmetric = true}},
  };
}

}  // namespace mbs::starting_dense
