// Describes the dense Eigen implementation and makes its simulations.
#include "mbs/implementation.hpp"

#include <Eigen/Core>
#include <memory>
#include <string>

#include "simulation.hpp"

namespace mbs::eigen_dense {

namespace {

std::unique_ptr<mbs::Simulation> create(const Model& model, const StepSettings& settings) {
  return std::make_unique<Simulation>(model, settings);
}

std::string eigen_version() {
  return std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
         std::to_string(EIGEN_MINOR_VERSION);
}

}  // namespace

Implementation implementation() {
  Implementation description;
  description.description = "dense column-major storage, rank-k update, Cholesky (LLT)";
  description.library = "Eigen";
  description.version = eigen_version();
  description.licence = "MPL-2.0";
  description.variants = {{.name = "llt",
                           .description = "Cholesky in place on the lower triangle",
                           .create = create,
                           .dense = true}};
  return description;
}

}  // namespace mbs::eigen_dense
