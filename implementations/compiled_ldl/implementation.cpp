// compiled_ldl: describes it and makes its simulations.
#include "mbs/implementation.hpp"

#include "batch.hpp"
#include "chain.hpp"
#include "scalar.hpp"
#include "simulations.hpp"

namespace mbs::compiled_ldl {
namespace {

constexpr Serves kAll = {.saddle_point = true,
                         .rattle = true,
                         .multiplier_update = true,
                         .tangent_reuse = true,
                         .projections_every = true,
                         .single_precision = true,
                         .mixed_precision = true,
                         .geometric_stiffness = true};

std::unique_ptr<Simulation> create_fronts(const Model& model, const StepSettings& settings) {
  switch (settings.precision) {
    case Precision::single_precision:
      return create_single(model, settings);
    case Precision::mixed:
      return create_mixed(model, settings);
    default:
      return create_double(model, settings);
  }
}

std::unique_ptr<Simulation> create_chains(const Model& model, const StepSettings& settings) {
  auto simulation = chain::create(model, settings);
  return simulation ? std::move(simulation) : create_fronts(model, settings);
}

std::unique_ptr<BatchSimulation> create_chain_batch(std::span<const Model* const> models,
                                                    std::span<const StepSettings> settings) {
  auto batch = chain::create_batch(models, settings);
  return batch ? std::move(batch) : create_batch(models, settings);
}

}  // namespace

Implementation implementation() {
  Variant fronts;
  fronts.name = "fronts";
  fronts.description = "dense fronts of points, merged and ordered by predicted time, for any scene";
  fronts.create = create_fronts;
  fronts.serves = kAll;
  fronts.create_batch = create_batch;
  fronts.batch_lanes = Lanes::kCount;
  Variant chains = fronts;
  chains.name = "chains";
  chains.description = "kernels for a chain of points where the scene is one, else fronts";
  chains.create = create_chains;
  chains.create_batch = create_chain_batch;
  chains.batch_lanes = chain::batch_lanes();
  Implementation all;
  all.description = "the scene compiled into a flat program; block L D L^T in dense fronts";
  all.library = "none";
  all.variants = {chains, fronts};
  return all;
}

}  // namespace mbs::compiled_ldl
