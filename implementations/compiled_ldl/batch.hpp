// Many simulations of one pattern at once, eight side by side in the lanes of a vector.
#pragma once

#include <memory>
#include <span>

#include "mbs/batch.hpp"

namespace mbs::compiled_ldl {

/// Throws Unsupported unless the scheme is the default one in double precision, with lambda updated
/// and the matrix, without geometric stiffness, factorized every pass, and no model has couples.
std::unique_ptr<BatchSimulation> create_batch(std::span<const Model* const> models,
                                              std::span<const StepSettings> settings);

}  // namespace mbs::compiled_ldl
