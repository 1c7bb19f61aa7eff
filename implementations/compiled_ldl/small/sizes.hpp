// Simulations of small scenes by their number of rows, in files compiled side by side.
#pragma once

#include <memory>

#include "small/stepper.hpp"

namespace mbs::compiled_ldl {

/// Of the first of the sizes N, More that the model fits in; nothing if it is larger than all.
template <int D, int N, int... More>
std::unique_ptr<Simulation> create_of_size(const Model& model, const StepSettings& settings) {
  if (model.variables() <= N) return std::make_unique<SmallStepper<N, D>>(model, settings);
  if constexpr (sizeof...(More) > 0) return create_of_size<D, More...>(model, settings);
  return nullptr;
}

/// Nothing if the model has more than 10 rows, or 16.
std::unique_ptr<Simulation> create_up_to_10(const Model& model, const StepSettings& settings);
std::unique_ptr<Simulation> create_up_to_16(const Model& model, const StepSettings& settings);

}  // namespace mbs::compiled_ldl
