// Describes the dense Eigen implementation and makes its simulations.
#include "mbs/implementation.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <string>

#include "simulation.hpp"

namespace mbs::eigen_dense {

namespace {

/// No matrix larger than this is stored; there are three or four of them.
constexpr double kMatrixLimit = 2.0 * 1024 * 1024 * 1024;  // bytes

std::unique_ptr<mbs::Simulation> create(const Model& model, const StepSettings& settings) {
  const double columns = std::max(model.variables(), model.constraints());
  if (sizeof(double) * columns * model.variables() > kMatrixLimit) {
    throw Unsupported("a dense matrix of " + std::to_string(model.variables()) +
                      " variables would exceed 2 GiB");
  }
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
