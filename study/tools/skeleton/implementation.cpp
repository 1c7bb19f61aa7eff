// Describes @name@ to the harness.
#include "mbs/implementation.hpp"

#include <memory>
#include <string>

#include "simulation.hpp"

@% if library == "blas" %@
extern "C" void ilaver_(int* major, int* minor, int* patch);

@% endif %@
namespace mbs::@name@ {
namespace {

@% if library == "blas" %@
std::string lapack_version() {
  int major = 0, minor = 0, patch = 0;
  ilaver_(&major, &minor, &patch);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

@% endif %@
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return std::make_unique<Stepper>(model, settings);
}

}  // namespace

Implementation implementation() {
  return {
      .description = "TODO: storage and algorithm in a line",
@% if library == "none" %@
      .library = "none",
      .version = "",
      .licence = "",
@% elif library == "eigen" %@
      .library = "Eigen",
      .version = std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION),
      .licence = "MPL-2.0",
@% else %@
      .library = "LAPACK",
      .version = lapack_version(),
      .licence = "BSD-3-Clause",
@% endif %@
      .variants = {{.name = "first",
                    .description = "TODO: what this variant does in a line",
                    .create = create,
                    .dense = true,  // without it, if T is not stored whole
                    .serves = {}}},  // terms and settings beyond the paper's step: mbs/terms.hpp
  };
}

}  // namespace mbs::@name@
