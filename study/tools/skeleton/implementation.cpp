// Describes @NAME@ to the harness.
#include "mbs/implementation.hpp"

#include <memory>
#include <string>

#include "simulation.hpp"
@ILAVER@
namespace mbs::@NAME@ {
namespace {

@LAPACK@std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return std::make_unique<Stepper>(model, settings);
}

}  // namespace

Implementation implementation() {
  return {
      .description = "TODO: storage and algorithm in a line",
      .library = "@LIBRARY@",
      .version = @VERSION@,
      .licence = "@LICENCE@",
      .variants = {{.name = "first",
                    .description = "TODO: what this variant does in a line",
                    .create = create,
                    .dense = true,  // without it, if T is not stored whole
                    .serves = {}}},  // terms and settings beyond the paper's step: mbs/terms.hpp
  };
}

}  // namespace mbs::@NAME@
