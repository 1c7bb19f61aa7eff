// Mechanisms of one shape that differ in every number.
#pragma once

#include <memory>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs {

/// All that a batch, and a simulation of each of its lanes alone, is made from.
struct VariedLanes {
  std::vector<std::unique_ptr<Model>> models;  // lanes refer to them
  std::vector<const Model*> pointers;
  std::vector<StepSettings> settings;
  std::vector<State> starts;

  [[nodiscard]] int count() const { return static_cast<int>(models.size()); }
};

/// `count` lanes like `model`, each with all numbers of its own (lengths where nothing has one by
/// itself, such as a unit vector or a driver), that start where `start`, a state of the model, is.
/// From one to the next, masses grow by `mass_apart` of the model's, lengths by half of that;
/// forces with the square of the mass. Drivers are where and as fast as they were at the start, and
/// then go on more slowly.
VariedLanes vary_lanes(int count, double mass_apart, const Model& model,
                       const StepSettings& settings, const State& start);

}  // namespace mbs
