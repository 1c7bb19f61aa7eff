// What this folder offers: description and factories.
#include "mbs/implementation.hpp"

#include "simulation.hpp"

namespace mbs::eigen_superlu {
namespace {

std::string versions() {
  const auto dotted = [](int a, int b, int c) {
    return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c);
  };
  return "Eigen " + dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION) +
         ", SuperLU " + SuperluSolver::version();
}

template <class Solver>
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return std::make_unique<SparseSimulation<Solver>>(model, settings);
}

}  // namespace

Implementation implementation() {
  return {
      .description =
          "Eigen's sparse matrices, values refreshed in place; SuperLU or simplicial LDL^T",
      .library = "Eigen, SuperLU",
      .version = versions(),
      .licence = "MPL-2.0 AND BSD-3-Clause",
      .variants = {
          {.name = "superlu",
           .description = "supernodal LU with diagonal pivots; ordering, tree and storage reused",
           .create = create<SuperluSolver>,
           .allocates = "SuperLU's dgstrf and sp_dtrsv allocate their work space in every call",
           .unsymmetric = true},
          {"simplicial_ldlt", "Eigen's up-looking LDL^T, AMD ordering", create<SimplicialSolver>}}};
}

}  // namespace mbs::eigen_superlu
