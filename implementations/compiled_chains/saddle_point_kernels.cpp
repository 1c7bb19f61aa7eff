// The saddle-point form.
#include "kinds.hpp"
#include "trapezoidal_simulation.hpp"

namespace mbs::compiled_chains {
namespace {

template <template <class> class MassOf, class Rods>
using Kind = TrapezoidalSimulation<SaddlePointForm, MassOf, Rods>;

}  // namespace

std::unique_ptr<Simulation> create_saddle_point(const Model& model, const StepSettings& settings,
                                                Topology topology) {
  return create_of_kind<Kind>(model, settings, std::move(topology));
}

}  // namespace mbs::compiled_chains
