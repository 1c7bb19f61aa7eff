// Which kernel serves a chain with some settings.
#include "chain.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "chain_batch.hpp"
#include "chain_penalty_group.hpp"
#include "chain_rattle_group.hpp"
#include "chain_rattle_simulation.hpp"
#include "chain_trapezoidal.hpp"

namespace mbs::compiled_ldl::chain {
namespace dispatch {

bool is_served(const StepSettings& settings) {
  return settings.multipliers == MultiplierUpdate::every_pass &&
         settings.tangent == TangentReuse::none &&
         settings.precision == Precision::double_precision && !settings.geometric_stiffness &&
         settings.penalty > 0.0 && std::isfinite(settings.penalty) && settings.max_passes >= 1;
}

/// Calls `make` with the kind of mass and rods that all of `chains` are.
template <class Make>
auto with_kind(std::span<const Topology> chains, const Make& make) {
  bool isotropic = true;
  int least = kMostRods;
  int most = 0;
  for (const Topology& chain : chains) {
    isotropic = isotropic && chain.isotropic;
    least = std::min(least, chain.least_rods);
    most = std::max(most, chain.most_rods);
  }
  if (!isotropic) return make.template operator()<GeneralMass, AtMostRods<kMostRods>>();
  if (most > 1) return make.template operator()<IsotropicMass, AtMostRods<kMostRods>>();
  if (least == 1) return make.template operator()<IsotropicMass, OneRod>();
  return make.template operator()<IsotropicMass, AtMostRods<1>>();
}

}  // namespace dispatch

std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  if (!dispatch::is_served(settings)) return nullptr;
  auto topology = find_chain(model);
  if (!topology) return nullptr;
  return dispatch::with_kind({&*topology, 1}, [&]<template <class> class MassOf, class Rods>() {
    std::unique_ptr<Simulation> simulation;
    if (settings.scheme == Scheme::penalty) {
      using Kind = TrapezoidalSimulation<PenaltyForm, MassOf, Rods>;
      simulation = std::make_unique<Kind>(model, settings, std::move(*topology));
    } else if (settings.scheme == Scheme::saddle_point) {
      using Kind = TrapezoidalSimulation<SaddlePointForm, MassOf, Rods>;
      simulation = std::make_unique<Kind>(model, settings, std::move(*topology));
    } else {
      using Kind = RattleSimulation<MassOf, Rods>;
      simulation = std::make_unique<Kind>(model, settings, std::move(*topology));
    }
    return simulation;
  });
}

std::unique_ptr<BatchSimulation> create_batch(std::span<const Model* const> models,
                                              std::span<const StepSettings> settings) {
  std::vector<Topology> chains;
  for (std::size_t lane = 0; lane < models.size() && lane < settings.size(); ++lane) {
    if (settings[lane].scheme == Scheme::saddle_point || !dispatch::is_served(settings[lane])) {
      return nullptr;
    }
    auto topology = find_chain(*models[lane]);
    if (!topology) return nullptr;
    chains.push_back(std::move(*topology));
  }
  if (chains.empty()) return nullptr;
  return dispatch::with_kind(chains, [&]<template <class> class MassOf, class Rods>() {
    std::unique_ptr<BatchSimulation> batch;
    if (settings[0].scheme == Scheme::penalty) {
      using Batch = ChainBatch<PenaltyGroup<MassOf, Rods>>;
      batch = std::make_unique<Batch>(models, settings, std::move(chains));
    } else {
      using Batch = ChainBatch<RattleGroup<MassOf, Rods>>;
      batch = std::make_unique<Batch>(models, settings, std::move(chains));
    }
    return batch;
  });
}

int batch_lanes() { return 4 * Lanes<Wide>::kChains; }

}  // namespace mbs::compiled_ldl::chain
