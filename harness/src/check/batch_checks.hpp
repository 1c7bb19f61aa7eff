// What a batch must pass: its lanes against the reference and against simulations alone.
#pragma once

#include <vector>

#include "check/reference_run.hpp"
#include "check/verdict.hpp"
#include "registry/registry.hpp"

namespace mbs {

/// For a variant with create_batch, batches of 3 and of 11 lanes of `model` with other masses,
/// forces, lengths and penalty factors, one of them spoiled from the start and one retired midway.
/// "batch": one step of each sound lane from the start of the stretch, by the tolerances of a lock
/// step. "batch-running": q of each and the number of passes against a Simulation of the lane,
/// after every step of up to 200, or what `seconds` allow. Not run where the variant takes no such
/// batch.
std::vector<Check> batch_checks(const Variant& variant, const Model& model,
                                const StepSettings& settings, const ReferenceRun& reference,
                                double seconds);

}  // namespace mbs
