// Which kernel serves a chain with some settings.
#include "kernels.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "batch.hpp"
#include "multistep_simulation.hpp"
#include "penalty_group.hpp"
#include "rattle_group.hpp"
#include "rattle_simulation.hpp"
#include "trapezoidal_simulation.hpp"

namespace mbs::compiled_chains {
namespace dispatch {

Topology topology_of(const Model& model) {
  auto topology = find_chain(model);
  if (topology) return std::move(*topology);
  throw Unsupported(
      "the scene is not a chain of free points (planar; masses and distances alone, each between "
      "neighbours or with at most two fixed points): use compiled_ldl/fronts");
}

/// Calls `make` with the kind of mass and rods that all of `chains` are.
template <class Make>
auto with_kind(std::span<const Topology> chains, const Make& make) {
  bool isotropic = true;
  bool uniform = true;
  int least = kMostRods;
  int most = 0;
  for (const Topology& chain : chains) {
    isotropic = isotropic && chain.isotropic;
    uniform = uniform && chain.coupling > 0.0;
    least = std::min(least, chain.least_rods);
    most = std::max(most, chain.most_rods);
  }
  if (!isotropic) return make.template operator()<GeneralMass, AtMostRods<kMostRods>>();
  if (most > 1) return make.template operator()<IsotropicMass, AtMostRods<kMostRods>>();
  if (uniform && least == 1) return make.template operator()<UniformMass, OneRod>();
  return make.template operator()<IsotropicMass, AtMostRods<1>>();
}

}  // namespace dispatch

std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  Topology topology = dispatch::topology_of(model);
  return dispatch::with_kind({&topology, 1}, [&]<template <class> class MassOf, class Rods>() {
    std::unique_ptr<Simulation> simulation;
    switch (settings.scheme) {
      case Scheme::penalty: {
        using Kind = TrapezoidalSimulation<PenaltyForm, MassOf, Rods>;
        simulation = std::make_unique<Kind>(model, settings, std::move(topology));
        break;
      }
      case Scheme::saddle_point: {
        using Kind = TrapezoidalSimulation<SaddlePointForm, MassOf, Rods>;
        simulation = std::make_unique<Kind>(model, settings, std::move(topology));
        break;
      }
      case Scheme::multistep6: {
        using Kind = MultistepSimulation<MassOf, Rods>;
        simulation = std::make_unique<Kind>(model, settings, std::move(topology));
        break;
      }
      case Scheme::rattle:
      case Scheme::rattle4:
      case Scheme::rattle6: {
        using Kind = RattleSimulation<MassOf, Rods>;
        simulation = std::make_unique<Kind>(model, settings, std::move(topology));
        break;
      }
    }
    return simulation;
  });
}

std::unique_ptr<BatchSimulation> create_batch(std::span<const Model* const> models,
                                              std::span<const StepSettings> settings) {
  switch (settings.front().scheme) {
    case Scheme::saddle_point:
      throw Unsupported("batches are not for the saddle-point form");
    case Scheme::multistep6:
      throw Unsupported("batches are not for the multistep method");
    case Scheme::penalty:
    case Scheme::rattle:
    case Scheme::rattle4:
    case Scheme::rattle6:
      break;
  }
  std::vector<Topology> chains;
  for (const Model* model : models) chains.push_back(dispatch::topology_of(*model));
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

int batch_lanes() { return 2 * Lanes<Wide>::kChains; }

}  // namespace mbs::compiled_chains
