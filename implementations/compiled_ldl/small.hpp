// Simulations of scenes of a few points, for which latency decides.
#pragma once

#include <memory>

#include "mbs/simulation.hpp"

namespace mbs::compiled_ldl {

/// Nothing if the scene has too many coordinates, or the settings are not the default ones.
std::unique_ptr<Simulation> create_small(const Model& model, const StepSettings& settings);

}  // namespace mbs::compiled_ldl
