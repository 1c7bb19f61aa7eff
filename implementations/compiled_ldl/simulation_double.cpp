// Simulations in double precision.
#include "simulations.hpp"
#include "stepper.hpp"

namespace mbs::compiled_ldl {

std::unique_ptr<Simulation> create_double(const Model& model, const StepSettings& settings) {
  if (auto small = create_small(model, settings)) return small;
  if (model.dimension() == 2) return std::make_unique<Stepper<double, double, 2>>(model, settings);
  return std::make_unique<Stepper<double, double, 3>>(model, settings);
}

}  // namespace mbs::compiled_ldl
