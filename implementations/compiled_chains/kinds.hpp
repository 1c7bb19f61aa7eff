// Kernels for each kind of masses and rods: a file a scheme, compiled side by side.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "storage.hpp"

namespace mbs {
class BatchSimulation;
}

namespace mbs::compiled_chains {

std::unique_ptr<Simulation> create_penalty(const Model& model, const StepSettings& settings,
                                           Topology topology);
std::unique_ptr<Simulation> create_saddle_point(const Model& model, const StepSettings& settings,
                                                Topology topology);
std::unique_ptr<Simulation> create_multistep(const Model& model, const StepSettings& settings,
                                             Topology topology);
std::unique_ptr<Simulation> create_rattle(const Model& model, const StepSettings& settings,
                                          Topology topology);

std::unique_ptr<BatchSimulation> create_penalty_batch(std::span<const Model* const> models,
                                                      std::span<const StepSettings> settings,
                                                      std::vector<Topology> chains);
std::unique_ptr<BatchSimulation> create_rattle_batch(std::span<const Model* const> models,
                                                     std::span<const StepSettings> settings,
                                                     std::vector<Topology> chains);

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
  if (!isotropic && most > 1) return make.template operator()<GeneralMass, AtMostRods<kMostRods>>();
  if (!isotropic) return make.template operator()<GeneralMass, AtMostRods<1>>();
  if (most > 1) return make.template operator()<IsotropicMass, AtMostRods<kMostRods>>();
  if (uniform && least == 1) return make.template operator()<UniformMass, OneRod>();
  return make.template operator()<IsotropicMass, AtMostRods<1>>();
}

/// A simulation of that kind: `Kind<MassOf, Rods>`. Never a template of an unnamed namespace: with
/// GCC 12 `create_of_kind` of two files is then one symbol, and one file makes the other's kernels.
template <template <template <class> class, class> class Kind>
std::unique_ptr<Simulation> create_of_kind(const Model& model, const StepSettings& settings,
                                           Topology topology) {
  return with_kind({&topology, 1},
                   [&]<template <class> class MassOf, class Rods>() -> std::unique_ptr<Simulation> {
                     return std::make_unique<Kind<MassOf, Rods>>(model, settings,
                                                                 std::move(topology));
                   });
}

}  // namespace mbs::compiled_chains
