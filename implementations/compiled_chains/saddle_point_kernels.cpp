// The saddle-point form.
#include "kinds.hpp"
#include "trapezoidal_simulation.hpp"

namespace mbs::compiled_chains {

std::unique_ptr<Simulation> create_saddle_point(const Model& model, const StepSettings& settings,
                                                Topology topology) {
  return create_of_kind<SaddlePointSimulation>(model, settings, std::move(topology));
}

}  // namespace mbs::compiled_chains
