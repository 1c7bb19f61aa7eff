// The registry of `mbs_reference`: the reference in place of the implementations.
#include <memory>

#include "reference/reference_simulation.hpp"
#include "registry/factory.hpp"
#include "registry/registry.hpp"

namespace mbs {
namespace {

std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return std::make_unique<ReferenceSimulation>(model, settings);
}

Implementation reference() {
  return {.description = "the equations literally, in long double over an envelope L D L^T",
          .library = "none",
          .version = "0",
          .licence = "none",
          .variants = {{.name = "reference",
                        .description = "what the others are held against",
                        .create = create,
                        .allocates = "its matrices and vectors are made anew in every step",
                        .serves = {.terms = all_terms(),
                                   .saddle_point = true,
                                   .rattle = true,
                                   .multistep = true,
                                   .multiplier_update = true,
                                   .tangent_reuse = true,
                                   .projections_every = true,
                                   .single_precision = true,
                                   .mixed_precision = true,
                                   .geometric_stiffness = true}}}};
}

}  // namespace

const std::vector<RegistryEntry>& registry() {
  static const std::vector<RegistryEntry> entries{available("reference", reference())};
  return entries;
}

}  // namespace mbs
