// The step with default settings of the chains in a register, sweep by sweep.
#pragma once

#include <memory>
#include <span>

#include "batch.hpp"
#include "projection.hpp"

namespace mbs::compiled_chains {

template <template <class> class MassOf, class Rods>
class PenaltyGroup : public LaneGroup<Storage<Wide, MassOf, Rods, PassBlock>> {
 public:
  using Store = Storage<Wide, MassOf, Rods, PassBlock>;
  using LaneGroup<Store>::LaneGroup;

  void get_state(int chain, const Topology& topology, const StepSettings& settings,
                 State& state) const {
    chain_.get(chain, topology, Units(settings, topology), state);
  }

  /// Two groups at most, sweep by sweep: while one waits at the end of a sweep for the number that
  /// the next one begins with, the processor has the other's to do.
  static void step_together(std::span<const std::unique_ptr<PenaltyGroup>> groups) {
    for (const auto& group : groups) group->begin();
    inwards_of<true>(groups);
    outwards_of<true>(groups);
    for (bool more = true; more;) {
      more = false;
      for (const auto& group : groups) more = group->decide() || more;
      inwards_of<false>(groups);
      outwards_of<false>(groups);
    }
    for (const auto& group : groups) group->choose_projections();
    const bool by_turns = groups.size() == 2 && groups[0]->projections_ == Projections::both &&
                          groups[1]->projections_ == Projections::both;
    if (by_turns) {
      Projection<Store>::both(groups[0]->chain_, groups[1]->chain_);
    } else {
      for (const auto& group : groups) group->project();
    }
  }

 private:
  using Base = LaneGroup<Store>;
  using Base::chain_, Base::failed_, Base::limit_, Base::passes_, Base::running_;
  using typename Base::V;
  using Mask = WideMask;

  void begin() {
    passes_ = failed_ = limit_ = Mask{};
    whole_ = more_ = true;
    pass_ = 1;
    active_ = running_;
  }

  /// Books the pass that has been done, and decides about another one. A chain that has converged
  /// or failed takes no part in further ones.
  bool decide() {
    if (!more_) return false;
    passes_ += active_;
    failed_ |= active_ & ~where(result_.least > V{});
    active_ &= ~where(result_.largest <= this->tolerance_) & ~failed_;
    more_ = any(active_);
    if (more_ && pass_ >= this->settings_.max_passes) {
      limit_ = active_;
      more_ = false;
    }
    ++pass_;
    whole_ = whole_ && !(more_ && any(running_ & ~active_));
    return more_;
  }
  using Groups = std::span<const std::unique_ptr<PenaltyGroup>>;

  /// Two groups that both make another pass sweep block by block.
  static bool by_turns(Groups groups) {
    return groups.size() == 2 && groups[0]->more_ && groups[1]->more_;
  }
  template <bool kFirst>
  static void inwards_of(Groups groups) {
    if (!by_turns(groups)) {
      for (const auto& group : groups) group->template inwards<kFirst>();
    } else if (kFirst || (groups[0]->whole_ && groups[1]->whole_)) {
      both_inwards<Newton<Store, kFirst>>(*groups[0], *groups[1]);
    } else {
      both_inwards<Newton<Store, false, true>>(*groups[0], *groups[1]);
    }
  }
  template <bool kFirst>
  static void outwards_of(Groups groups) {
    if (!by_turns(groups)) {
      for (const auto& group : groups) group->template outwards<kFirst>();
    } else if (kFirst || (groups[0]->whole_ && groups[1]->whole_)) {
      both_outwards<Newton<Store, kFirst>>(*groups[0], *groups[1]);
    } else {
      both_outwards<Newton<Store, false, true>>(*groups[0], *groups[1]);
    }
  }
  template <class Passes>
  static void both_inwards(PenaltyGroup& a, PenaltyGroup& b) {
    Passes::inwards(a.chain_, a.active_, a.result_.least, b.chain_, b.active_, b.result_.least);
  }
  template <class Passes>
  static void both_outwards(PenaltyGroup& a, PenaltyGroup& b) {
    Passes::outwards(a.chain_, a.active_, a.result_.largest, b.chain_, b.active_,
                     b.result_.largest);
  }
  template <bool kFirst>
  void inwards() {
    if (!more_) return;
    result_.least = kFirst || whole_ ? Newton<Store, kFirst>::inwards(chain_, Mask())
                                     : Newton<Store, false, true>::inwards(chain_, active_);
  }
  template <bool kFirst>
  void outwards() {
    if (!more_) return;
    result_.largest = kFirst || whole_ ? Newton<Store, kFirst>::outwards(chain_, Mask())
                                       : Newton<Store, false, true>::outwards(chain_, active_);
  }

  void choose_projections() {
    const bool due = ++this->steps_ % this->settings_.projections_every == 0;
    projections_ = due ? this->settings_.projections : Projections::none;
  }
  void project() {
    using Project = Projection<Store>;
    if (projections_ == Projections::none) return Project::settle(chain_);
    Project::velocity(chain_);
    if (projections_ == Projections::both) Project::acceleration(chain_);
  }

  Projections projections_ = Projections::both;  // that this step ends with
  PassResult<V> result_{};
  Mask active_{};      // which chains take part in the next pass
  bool whole_ = true;  // all took part in all passes
  bool more_ = true;   // another pass is to be done
  int pass_ = 1;
};

}  // namespace mbs::compiled_chains
