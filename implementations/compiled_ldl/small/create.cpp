// Simulations of small scenes, if the settings are the default ones.
#include <utility>

#include "simulations.hpp"
#include "small/sizes.hpp"

namespace mbs::compiled_ldl {

std::unique_ptr<Simulation> create_small(const Model& model, const StepSettings& settings) {
  if (settings.scheme != Scheme::penalty || settings.multipliers != MultiplierUpdate::every_pass ||
      settings.tangent != TangentReuse::none || settings.geometric_stiffness) {
    return nullptr;
  }
  auto simulation = create_up_to_10(model, settings);
  return simulation ? std::move(simulation) : create_up_to_16(model, settings);
}

}  // namespace mbs::compiled_ldl
