// RATTLE and its compositions for the chains in a register.
#pragma once

#include <memory>
#include <span>

#include "batch.hpp"
#include "rattle.hpp"

namespace mbs::compiled_chains {

template <template <class> class MassOf, class Rods>
class RattleGroup : public LaneGroup<Storage<Wide, MassOf, Rods, RowBlock>> {
 public:
  using Store = Storage<Wide, MassOf, Rods, RowBlock>;

  RattleGroup(int places, const StepSettings& settings)
      : Base(places, settings), stages_(stage_lengths(settings.scheme)) {
    this->factorizations_ = static_cast<int>(stages_.size());
  }

  void set_state(int chain, const Topology& topology, const StepSettings& settings,
                 const State& state) {
    Base::set_state(chain, topology, settings, state);
    prepared_ = false;
  }
  void get_state(int chain, const Topology& topology, const StepSettings& settings,
                 State& state) const {
    prepare();
    if (!settled_) Stage::settle(chain_);
    settled_ = true;
    chain_.get(chain, topology, Units(settings, topology), state);
  }

  static void step_together(std::span<const std::unique_ptr<RattleGroup>> groups) {
    for (const auto& group : groups) group->step();
  }

 private:
  using Base = LaneGroup<Store>;
  using Base::chain_, Base::failed_, Base::limit_, Base::passes_, Base::running_;
  using typename Base::V;
  using Mask = WideMask;
  using Stage = RattleStage<Store>;
  using MaskedStage = RattleStage<Store, true>;

  /// What set_state() of a single simulation does, when all states are there.
  void prepare() const {
    if (this->steps_ != 0 || prepared_) return;
    Stage::template factorize<false>(chain_, 1.0);
    find_acceleration(running_);
    prepared_ = true;
  }

  void step() {
    prepare();
    prepared_ = false;
    ++this->steps_;
    passes_ = failed_ = limit_ = Mask{};
    for (const double length : stages_) stage(length);
  }

  void stage(double length) {
    const Mask sound = running_ & ~failed_;
    Mask active = sound;
    V largest = Stage::template pass<true>(chain_, length);
    for (int pass = 1;; ++pass) {
      passes_ += active;
      active &= large(largest);
      if (!any(active)) break;
      if (pass >= this->settings_.max_passes) {
        limit_ |= active;
        break;
      }
      largest = MaskedStage::template pass<false>(chain_, length, active);
    }
    failed_ |= sound & ~where(Stage::template factorize<true>(chain_, length) > V{});
    active = running_ & ~failed_ & large(Stage::refine_velocity(chain_));
    for (int k = 1; k < kMostRefinements && any(active); ++k) {
      active &= large(MaskedStage::refine_velocity(chain_, active));
    }
    find_acceleration(running_ & ~failed_);
  }

  void find_acceleration(Mask active) const {
    Stage::acceleration(chain_);
    active &= large(Stage::template refine_acceleration<true>(chain_));
    for (int k = 1; k < kMostRefinements && any(active); ++k) {
      active &= large(MaskedStage::template refine_acceleration<false>(chain_, active));
    }
    settled_ = false;
  }

  [[nodiscard]] Mask large(const V& largest) const { return ~where(largest <= this->tolerance_); }

  std::span<const double> stages_;
  mutable bool settled_ = true;
  mutable bool prepared_ = false;
};

}  // namespace mbs::compiled_chains
