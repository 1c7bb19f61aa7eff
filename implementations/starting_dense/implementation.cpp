// Describes starting_dense to the harness.
#include "mbs/implementation.hpp"

#include <algorithm>
#include <memory>
#include <string>

#include "simulation.hpp"

namespace mbs::starting_dense {

namespace {

constexpr Terms kTerms{Term::dots,        Term::bilinear,        Term::linear,
                       Term::springs,     Term::torsion_springs, Term::dampers,
                       Term::couples,     Term::drivers,         Term::mass_across_axes,
                       Term::spatial};

/// A dense matrix of more than 2 GiB is refused: four of them are kept.
constexpr double kLargest = 2.0 * 1024 * 1024 * 1024;

std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  const double n = model.variables(), m = model.constraints();
  if (8.0 * n * std::max(n, m) > kLargest) {
    throw Unsupported("dense matrices of " + std::to_string(model.variables()) + " variables and " +
                      std::to_string(model.constraints()) + " constraints exceed 2 GiB each");
  }
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
                    .unsymmetric = true,
                    .serves = {.terms = kTerms}}},
      .role = Role::paper,
  };
}

}  // namespace mbs::starting_dense
