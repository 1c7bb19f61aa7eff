// RATTLE and its compositions on a chain (paper/README.md, "RATTLE"): stages, passes, refinements.
#pragma once

#include <span>
#include <utility>

#include "chain_rattle.hpp"
#include "mbs/simulation.hpp"

namespace mbs::compiled_ldl::chain {

template <template <class> class MassOf, class Rods>
class RattleSimulation final : public Simulation {
 public:
  RattleSimulation(const Model& model, const StepSettings& settings, Topology topology)
      : Simulation(model, settings),
        stages_(stage_lengths(settings.scheme)),
        max_passes_(settings.max_passes),
        topology_(std::move(topology)),
        units_(settings),
        tolerance_(2.0 * units_.length * settings.tolerance),
        chain_(static_cast<int>(topology_.places.size())) {}

 private:
  using Store = Storage<Pair, MassOf, Rods, RowBlock>;
  using Stage = RattleStage<Store>;

  void do_set_state(const State& state) override {
    chain_.set(0, topology_, units_, state);
    Stage::template factorize<false>(chain_, 1.0);  // if it fails, the first step does too
    find_acceleration();
  }

  void do_get_state(State& state) const override {
    if (!settled_) Stage::settle(chain_);
    settled_ = true;
    chain_.get(0, topology_, units_, state);
  }

  StepOutcome do_step() override {
    StepOutcome outcome{StepStatus::converged, 0, 0};
    for (const double length : stages_) {
      if (!stage(length, outcome)) {
        outcome.status = StepStatus::factorization_failed;
        return outcome;
      }
    }
    return outcome;
  }

  /// False if R(q') has no factors.
  bool stage(double length, StepOutcome& outcome) {
    Pair largest = Stage::template pass<true>(chain_, length);
    int passes = 1;
    for (; !is_small(largest); ++passes) {
      if (passes >= max_passes_) {
        outcome.status = StepStatus::pass_limit;
        break;
      }
      largest = Stage::template pass<false>(chain_, length);
    }
    outcome.passes += passes;
    ++outcome.factorizations;
    if (!is_factorized(Stage::template factorize<true>(chain_, length))) return false;
    int refinements = 1;
    while (!is_small(Stage::refine_velocity(chain_)) && refinements < kMostRefinements) {
      ++refinements;
    }
    find_acceleration();
    return true;
  }

  void find_acceleration() {
    Stage::acceleration(chain_);
    Pair largest = Stage::template refine_acceleration<true>(chain_);
    for (int refinements = 1; !is_small(largest) && refinements < kMostRefinements; ++refinements) {
      largest = Stage::template refine_acceleration<false>(chain_);
    }
    settled_ = false;
  }

  [[nodiscard]] bool is_small(const Pair& largest) const {
    return largest[0] <= tolerance_ && largest[1] <= tolerance_;
  }
  [[nodiscard]] static bool is_factorized(const Pair& least) {
    return least[0] > 0.0 && least[1] > 0.0;
  }

  std::span<const double> stages_;
  int max_passes_;
  Topology topology_;
  Units units_;
  double tolerance_;
  // The last term of λ is added when somebody asks for it: nothing in a step does.
  mutable Store chain_;
  mutable bool settled_ = true;
};

}  // namespace mbs::compiled_ldl::chain
