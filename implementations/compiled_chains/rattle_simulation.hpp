// RATTLE and its compositions on a chain (paper/README.md, "RATTLE"): stages, passes, refinements.
#pragma once

#include <span>
#include <utility>

#include "mbs/simulation.hpp"
#include "rattle.hpp"

namespace mbs::compiled_chains {

/// A chain and its stages.
template <class Store, class Elimination = Together>
class RattleSteps {
 public:
  using Stage = RattleStage<Store, false, Elimination>;

  RattleSteps(const StepSettings& settings, const Topology& topology)
      : units(settings, topology),
        max_passes(settings.max_passes),
        tolerance(2.0 * units.length * settings.tolerance),
        chain(static_cast<int>(topology.places.size())) {
    chain.set_constants(0, topology, units);
  }

  void begin(const Topology& topology, const State& state) {
    chain.set_state(0, topology, units, state);
    Stage::template factorize<false>(chain, 1.0);  // if it fails, the first step does too
    find_acceleration();
  }

  /// One after the other; `moved(length)` is told when the w of a stage is (q' − q)/h.
  template <class Moved>
  StepOutcome advance(std::span<const double> stages, const Moved& moved) {
    StepOutcome outcome{StepStatus::converged, 0, 0};
    for (const double length : stages) {
      if (!stage(length, moved, outcome)) {
        outcome.status = StepStatus::factorization_failed;
        return outcome;
      }
    }
    return outcome;
  }

  void refine_velocity() {
    int refinements = 1;
    while (!is_small(Stage::refine_velocity(chain)) && refinements < kMostRefinements) {
      ++refinements;
    }
  }

  /// But for the last term of λ, Stage::settle().
  void find_acceleration() {
    Stage::acceleration(chain);
    Pair largest = Stage::template refine_acceleration<true>(chain);
    for (int refinements = 1; !is_small(largest) && refinements < kMostRefinements; ++refinements) {
      largest = Stage::template refine_acceleration<false>(chain);
    }
  }

  [[nodiscard]] bool is_small(const Pair& largest) const {
    return largest[0] <= tolerance && largest[1] <= tolerance;
  }
  [[nodiscard]] static bool is_factorized(const Pair& least) {
    return least[0] > 0.0 && least[1] > 0.0;
  }

  Units units;
  int max_passes;
  double tolerance;
  Store chain;

 private:
  /// False if R(q') has no factors.
  template <class Moved>
  bool stage(double length, const Moved& moved, StepOutcome& outcome) {
    Pair largest = Stage::template pass<true>(chain, length);
    int passes = 1;
    for (; !is_small(largest); ++passes) {
      if (passes >= max_passes) {
        outcome.status = StepStatus::pass_limit;
        break;
      }
      largest = Stage::template pass<false>(chain, length);
    }
    moved(length);
    outcome.passes += passes;
    ++outcome.factorizations;
    if (!is_factorized(Stage::template factorize<true>(chain, length))) return false;
    refine_velocity();
    find_acceleration();
    return true;
  }
};

template <template <class> class MassOf, class Rods>
class RattleSimulation final : public Simulation {
 public:
  RattleSimulation(const Model& model, const StepSettings& settings, Topology topology)
      : Simulation(model, settings),
        stages_(stage_lengths(settings.scheme)),
        topology_(std::move(topology)),
        steps_(settings, topology_) {}

 private:
  using Store = Storage<Pair, MassOf, Rods, RowBlock>;
  using Steps = RattleSteps<Store>;

  void do_set_state(const State& state) override {
    steps_.begin(topology_, state);
    settled_ = false;
  }

  void do_get_state(State& state) const override {
    if (!settled_) Steps::Stage::settle(steps_.chain);
    settled_ = true;
    steps_.chain.get(0, topology_, steps_.units, state);
  }

  StepOutcome do_step() override {
    settled_ = false;
    return steps_.advance(stages_, [](double) {});
  }

  std::span<const double> stages_;
  Topology topology_;
  // The last term of λ is added when somebody asks for it: nothing in a step does.
  mutable Steps steps_;
  mutable bool settled_ = true;
};

}  // namespace mbs::compiled_chains
