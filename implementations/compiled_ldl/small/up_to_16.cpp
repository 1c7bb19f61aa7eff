// Small scenes of 11 to 16 rows.
#include "small/stepper.hpp"

namespace mbs::compiled_ldl {

std::unique_ptr<Simulation> create_up_to_16(const Model& model, const StepSettings& settings) {
  if (model.dimension() == 2) return create_of_size<2, 12, 14, 16>(model, settings);
  return create_of_size<3, 12, 16>(model, settings);
}

}  // namespace mbs::compiled_ldl
