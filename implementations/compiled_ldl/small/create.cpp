// Simulations of small scenes by their number of rows.
#include "simulations.hpp"
#include "small/stepper.hpp"

namespace mbs::compiled_ldl {
namespace {

template <int D, int N, int... More>
std::unique_ptr<Simulation> create_of(const Model& model, const StepSettings& settings) {
  if (model.variables() <= N) return std::make_unique<SmallStepper<N, D>>(model, settings);
  if constexpr (sizeof...(More) > 0) return create_of<D, More...>(model, settings);
  return nullptr;
}

}  // namespace

std::unique_ptr<Simulation> create_small(const Model& model, const StepSettings& settings) {
  if (settings.scheme != Scheme::penalty || settings.multipliers != MultiplierUpdate::every_pass ||
      settings.tangent != TangentReuse::none || settings.geometric_stiffness) {
    return nullptr;
  }
  if (model.dimension() == 2) return create_of<2, 2, 4, 6, 8, 10, 12, 14, 16>(model, settings);
  return create_of<3, 4, 6, 10, 12, 16>(model, settings);
}

}  // namespace mbs::compiled_ldl
