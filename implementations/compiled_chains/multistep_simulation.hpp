// The symmetric multistep method on a chain (paper/README.md): its start, its passes, its state.
#pragma once

#include <utility>

#include "multistep.hpp"
#include "rattle_simulation.hpp"

namespace mbs::compiled_chains {

template <template <class> class MassOf, class Rods>
class MultistepSimulation final : public Simulation {
 public:
  MultistepSimulation(const Model& model, const StepSettings& settings, Topology topology)
      : Simulation(model, settings), topology_(std::move(topology)), rattle_(settings, topology_) {}

 private:
  using Store = Storage<Pair, MassOf, Rods, MomentBlock>;
  using Steps = RattleSteps<Store, Apart>;
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
    switch (rattle_.chain.last) {  // short ones stay in registers from sweep to sweep
      case 1:
        return advance<1>();
      case 2:
        return advance<2>();
      default:
        return advance<0>();
    }
  }

  /// A step of the recursion; `kLast` is that of the chain, or 0: any.
  template <int kLast>
  StepOutcome advance() {
    Store& chain = rattle_.chain;
    if (kLast > 0 && chain.last != kLast) __builtin_unreachable();
    StepOutcome outcome{StepStatus::converged, 1, 1};
    const Pair least = Sweeps::begin(chain, ring_);
    Pair largest = Sweeps::outwards(chain, ring_);
    if (!Steps::is_factorized(least)) {
      outcome.status = StepStatus::factorization_failed;
      return outcome;
    }
    const auto pass = [&]() __attribute__((always_inline)) {
      Sweeps::inwards(chain);
      largest = Sweeps::outwards(chain, ring_);
      ++outcome.passes;
    };
    const int most = rattle_.max_passes;
    if (most > 1) pass();  // outside of the loop, so that it finds all in registers
    while (outcome.passes < most && !rattle_.is_small(largest)) pass();
    if (most < 2 || !rattle_.is_small(largest)) outcome.status = StepStatus::pass_limit;
    ring_.advance();
    return outcome;
  }

  StepOutcome start() {
    state_ = Has::all_but_settled;
    ++started_;
    compiled_chains::begin_start(rattle_.chain, ring_);
    const StepOutcome outcome = rattle_.advance(
        stage_lengths(Scheme::rattle6),
        [this](double length) { compiled_chains::add_stage(rattle_.chain, ring_, length); });
    ring_.advance();
    return outcome;
  }

  /// What is no part of the recursion is found when somebody asks for it. It leaves other factors
  /// than the step's, which the next one replaces.
  void do_get_state(State& state) const override {
    if (state_ == Has::positions) {
      compiled_chains::set_velocity(rattle_.chain, ring_);
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

}  // namespace mbs::compiled_chains
