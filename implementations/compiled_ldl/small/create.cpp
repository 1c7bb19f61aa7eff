// Simulations of small scenes, if the settings are the default ones; those of up to 10 rows.
#include "simulations.hpp"
#include "small/stepper.hpp"

namespace mbs::compiled_ldl {

std::unique_ptr<Simulation> create_small(const Model& model, const StepSettings& settings) {
  if (settings.scheme != Scheme::penalty || settings.multipliers != MultiplierUpdate::every_pass ||
      settings.tangent != TangentReuse::none || settings.geometric_stiffness) {
    return nullptr;
  }
  auto simulation = model.dimension() == 2 ? create_of_size<2, 2, 4, 6, 8, 10>(model, settings)
                                           : create_of_size<3, 4, 6, 10>(model, settings);
  if (simulation) return simulation;
  // Where a row takes four registers, dense is faster only what fronts would take as one.
  const int size = model.variables();
  if (kRegisterDoubles < 8 && size > 12 && size <= 16 &&
      program_of(model, settings, 8).fronts.size() > 1) {
    return nullptr;
  }
  return create_up_to_16(model, settings);
}

}  // namespace mbs::compiled_ldl
