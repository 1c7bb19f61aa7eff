// Small scenes of up to 10 rows.
#include "small/sizes.hpp"

namespace mbs::compiled_ldl {

std::unique_ptr<Simulation> create_up_to_10(const Model& model, const StepSettings& settings) {
  if (model.dimension() == 2) return create_of_size<2, 2, 4, 6, 8, 10>(model, settings);
  return create_of_size<3, 4, 6, 10>(model, settings);
}

}  // namespace mbs::compiled_ldl
