// Simulations in mixed precision.
#include "simulations.hpp"
#include "stepper.hpp"

namespace mbs::compiled_ldl {

std::unique_ptr<Simulation> create_mixed(const Model& model, const StepSettings& settings) {
  if (model.dimension() == 2) return std::make_unique<Stepper<double, float, 2>>(model, settings);
  return std::make_unique<Stepper<double, float, 3>>(model, settings);
}

}  // namespace mbs::compiled_ldl
