// The multistep method.
#include "kinds.hpp"
#include "multistep_simulation.hpp"

namespace mbs::compiled_chains {

std::unique_ptr<Simulation> create_multistep(const Model& model, const StepSettings& settings,
                                             Topology topology) {
  return create_of_kind<MultistepSimulation>(model, settings, std::move(topology));
}

}  // namespace mbs::compiled_chains
