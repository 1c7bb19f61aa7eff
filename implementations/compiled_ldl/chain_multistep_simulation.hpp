// The symmetric multistep method on a chain (paper/README.md): its start, its passes, its state.
#pragma once

#include <utility>

#include "chain_multistep.hpp"
#include "chain_rattle_simulation.hpp"

namespace mbs::compiled_ldl::chain {

template <template <class> class MassOf, class Rods>
class MultistepSimulation final : public Simulation {
 public:
  MultistepSimulation(const Model& model, const StepSettings& settings, Topology topology)
      : Simulation(model, settings),
        topology_(std::move(topology)),
        rattle_(settings, topology_) {}

 private:
  using Store = Storage<Pair, MassOf, Rods, MomentBlock>;
  using Steps = RattleSteps<Store>;
  using Sweeps = Multistep<Store>;

  void do_set_state(const State& state) override {
    rattle_.begin(topology_, state);
    ring_ = Ring();
    started_ = 0;
    state_ = Has::all_but_settled;
  }

  StepOutcome do_step() override {
    if (started_ < kPast) return start();
    state_ = Has::positions;
    Store& chain = rattle_.chain;
    const Pair least = Sweeps::begin(chain, ring_);
    Pair largest = Sweeps::outwards(chain, ring_);
    int passes = 1;
    StepOutcome outcome{StepStatus::converged, 1, 1};
    if (!Steps::is_factorized(least)) return {StepStatus::factorization_failed, 1, 1};
    while (passes < 2 || !rattle_.is_small(largest)) {
      if (passes >= rattle_.max_passes) {
        outcome.status = StepStatus::pass_limit;
        break;
      }
      Sweeps::inwards(chain);
      largest = Sweeps::outwards(chain, ring_);
      ++passes;
    }
    outcome.passes = passes;
    ring_.advance();
    return outcome;
  }

  StepOutcome start() {
    state_ = Has::all_but_settled;
    ++started_;
    Sweeps::begin_start(rattle_.chain, ring_);
    const StepOutcome outcome =
        rattle_.advance(stage_lengths(Scheme::rattle6), [this](double length) {
          Sweeps::add_stage(rattle_.chain, ring_, length);
        });
    ring_.advance();
    return outcome;
  }

  /// What is no part of the recursion is found when somebody asks for it. It leaves other factors
  /// than the step's, which the next one replaces.
  void do_get_state(State& state) const override {
    if (state_ == Has::positions) {
      Sweeps::velocity(rattle_.chain, ring_);
      Steps::Stage::template factorize<false>(rattle_.chain, 1.0);
      rattle_.refine_velocity();
      rattle_.find_acceleration();
      state_ = Has::all_but_settled;
    }
    if (state_ == Has::all_but_settled) Steps::Stage::settle(rattle_.chain);
    state_ = Has::all;
    rattle_.chain.get(0, topology_, rattle_.units, state);
  }

  enum class Has { positions, all_but_settled, all };

  Topology topology_;
  mutable Steps rattle_;
  mutable Has state_ = Has::all;
  Ring ring_;
  int started_ = 0;  // steps of the start
};

}  // namespace mbs::compiled_ldl::chain
