// Simulations by what they compute in; each in a source file of its own.
#pragma once

#include <memory>
#include <span>

#include "mbs/batch.hpp"
#include "mbs/simulation.hpp"

namespace mbs::compiled_ldl {

std::unique_ptr<Simulation> create_double(const Model& model, const StepSettings& settings);
std::unique_ptr<Simulation> create_single(const Model& model, const StepSettings& settings);
/// Factors in float, the rest in double.
std::unique_ptr<Simulation> create_mixed(const Model& model, const StepSettings& settings);

/// Of scenes of a few points, for which latency decides, in double precision: nothing if the scene
/// has too many coordinates, or the settings are not the default ones.
std::unique_ptr<Simulation> create_small(const Model& model, const StepSettings& settings);

/// Many of one pattern at once, side by side in the lanes of a register. Throws Unsupported
/// unless the scheme is the default one in double precision, with lambda updated and the matrix,
/// without geometric stiffness, factorized every pass.
std::unique_ptr<BatchSimulation> create_batch(std::span<const Model* const> models,
                                              std::span<const StepSettings> settings);

}  // namespace mbs::compiled_ldl
