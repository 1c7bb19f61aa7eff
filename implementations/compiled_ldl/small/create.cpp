// Simulations of small scenes, if the settings are the default ones.
#include "simulations.hpp"
#include "small/sizes.hpp"

namespace mbs::compiled_ldl {

std::unique_ptr<Simulation> create_small(const Model& model, const StepSettings& settings) {
  if (settings.scheme != Scheme::penalty || settings.multipliers != MultiplierUpdate::every_pass ||
      settings.tangent != TangentReuse::none || settings.geometric_stiffness) {
    return nullptr;
  }
  if (auto simulation = create_up_to_10(model, settings)) return simulation;
  // Where a row takes four registers, dense is faster only what fronts would take as one.
  const int size = model.variables();
  if (kRegisterDoubles < 8 && size > 12 && size <= 16 &&
      program_of(model, settings, 8).fronts.size() > 1) {
    return nullptr;
  }
  return create_up_to_16(model, settings);
}

}  // namespace mbs::compiled_ldl
