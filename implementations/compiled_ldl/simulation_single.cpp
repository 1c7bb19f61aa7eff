// Simulations in single precision.
#include "simulations.hpp"
#include "stepper.hpp"

namespace mbs::compiled_ldl {

std::unique_ptr<Simulation> create_single(const Model& model, const StepSettings& settings) {
  if (model.dimension() == 2) return std::make_unique<Stepper<float, float, 2>>(model, settings);
  return std::make_unique<Stepper<float, float, 3>>(model, settings);
}

}  // namespace mbs::compiled_ldl
