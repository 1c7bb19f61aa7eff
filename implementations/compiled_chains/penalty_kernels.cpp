// The penalty form, single chains and batches.
#include "batch.hpp"
#include "kinds.hpp"
#include "penalty_group.hpp"
#include "trapezoidal_simulation.hpp"

namespace mbs::compiled_chains {

std::unique_ptr<Simulation> create_penalty(const Model& model, const StepSettings& settings,
                                           Topology topology) {
  return create_of_kind<PenaltySimulation>(model, settings, std::move(topology));
}

std::unique_ptr<BatchSimulation> create_penalty_batch(std::span<const Model* const> models,
                                                      std::span<const StepSettings> settings,
                                                      std::vector<Topology> chains) {
  return with_kind(
      chains, [&]<template <class> class MassOf, class Rods>() -> std::unique_ptr<BatchSimulation> {
        using Batch = ChainBatch<PenaltyGroup<MassOf, Rods>>;
        return std::make_unique<Batch>(models, settings, std::move(chains));
      });
}

}  // namespace mbs::compiled_chains
