// What this folder offers: one variant, which exists to be read.
#include "mbs/implementation.hpp"

#include "simulation.hpp"

namespace mbs::minimal_dense {

// Variant::serves keeps its default: planar distances, constant mass matrix, gravity, paper's step.
Implementation implementation() {
  return {.description = "an example to read: the paper's step in plain loops, own Cholesky",
          .library = "none",
          .version = "",
          .licence = "",
          .variants = {{.name = "loops",
                        .description = "an example to read: full matrices, each product a loop",
                        .create = [](const Model& model,
                                     const StepSettings& settings) -> std::unique_ptr<Simulation> {
                          return std::make_unique<LoopsSimulation>(model, settings);
                        },
                        .dense = true}},
          .role = Role::example};
}

}  // namespace mbs::minimal_dense
