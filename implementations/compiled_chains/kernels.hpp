// Entry points of the kernels for chains of points.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "mbs/batch.hpp"
#include "mbs/simulation.hpp"

namespace mbs::compiled_chains {

/// Empty if `model` is a chain; else what the others throw as Unsupported.
std::string why_no_chain(const Model& model);

std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings);

/// The same for many at once, one a vector lane; Unsupported in the saddle-point form and the
/// multistep method, too.
std::unique_ptr<BatchSimulation> create_batch(std::span<const Model* const> models,
                                              std::span<const StepSettings> settings);

/// The number of lanes that a batch is best given.
int batch_lanes();

}  // namespace mbs::compiled_chains
