// Simulations by what they compute in; each in a source file of its own.
#pragma once

#include <memory>

#include "mbs/simulation.hpp"

namespace mbs::compiled_ldl {

std::unique_ptr<Simulation> create_double(const Model& model, const StepSettings& settings);
std::unique_ptr<Simulation> create_single(const Model& model, const StepSettings& settings);
/// Factors in float, the rest in double.
std::unique_ptr<Simulation> create_mixed(const Model& model, const StepSettings& settings);

}  // namespace mbs::compiled_ldl
