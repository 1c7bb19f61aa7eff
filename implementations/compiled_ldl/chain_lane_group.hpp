// As many chains as a register has room for, and which of them take part in a pass.
#pragma once

#include "chain_projection.hpp"

namespace mbs::compiled_ldl::chain {

/// The sweeps of a step, one by one. A lane without a chain is at rest.
template <template <class> class MassOf, class Rods>
class LaneGroup {
 public:
  static constexpr int kChains = Lanes<Wide>::kChains;

  LaneGroup(int places, const StepSettings& settings) : settings_(settings), chain_(places) {
    for (int chain = 0; chain < kChains; ++chain) clear(chain);
  }
  [[nodiscard]] std::size_t bytes() const { return chain_.bytes(); }

  void set(int chain, const Topology& topology, const StepSettings& settings, const State& state) {
    const Units units(settings);
    chain_.set(chain, topology, units, state);
    mark(chain, 2.0 * units.length * settings.tolerance, -1);
    until_projection_ = settings.projections_every;
  }
  void get(int chain, const Topology& topology, const StepSettings& settings, State& state) const {
    chain_.get(chain, topology, Units(settings), state);
  }
  void clear(int chain) {
    chain_.clear(chain);
    mark(chain, 1.0, 0);
  }

  void first_inwards() {
    passes_ = failed_ = limit_ = Mask{};
    whole_ = more_ = true;
    pass_ = 1;
    active_ = running_;
    result_.least = Newton<Store, true>::inwards(chain_, Taking<Mask>());
  }
  void first_outwards() { result_.largest = Newton<Store, true>::outwards(chain_, Mask()); }

  /// Books the pass that has been done, and decides about another one. A chain that has converged
  /// or failed takes no part in further ones.
  bool decide() {
    if (!more_) return false;
    passes_ += active_;
    last_ = active_;
    failed_ |= active_ & ~both(static_cast<Mask>(result_.least > V{}));
    active_ &= ~both(static_cast<Mask>(result_.largest <= tolerance_)) & ~failed_;
    more_ = any(active_);
    if (more_ && pass_ >= settings_.max_passes) {
      limit_ = active_;
      more_ = false;
    }
    ++pass_;
    whole_ = whole_ && !(more_ && any(running_ & ~active_));
    return more_;
  }
  void inwards() {
    if (!more_) return;
    result_.least = whole_
                        ? Newton<Store, false>::inwards(chain_, Taking<Mask>())
                        : Newton<Store, false, true>::inwards(chain_, Taking<Mask>{last_, active_});
  }
  void outwards() {
    if (!more_) return;
    result_.largest = whole_ ? Newton<Store, false>::outwards(chain_, Mask())
                             : Newton<Store, false, true>::outwards(chain_, active_);
  }

  void velocity_inwards() {
    const bool due = --until_projection_ == 0;
    if (due) until_projection_ = settings_.projections_every;
    projections_ = due ? settings_.projections : Projections::none;
    if (projections_ == Projections::none) return Projection<Store, true>::settle(chain_, last_);
    if (whole_) return Projection<Store>::velocity_inwards(chain_, Mask());
    Projection<Store, true>::velocity_inwards(chain_, last_);
  }
  void velocity_outwards() {
    if (projections_ != Projections::none) Projection<Store>::velocity_outwards(chain_);
  }
  void acceleration_inwards() {
    if (projections_ == Projections::both) Projection<Store>::acceleration_inwards(chain_);
  }
  void acceleration_outwards() {
    if (projections_ == Projections::both) Projection<Store>::acceleration_outwards(chain_);
  }

  [[nodiscard]] StepOutcome outcome(int chain) const {
    const int lane = 2 * chain;
    const StepStatus status = failed_[lane]  ? StepStatus::factorization_failed
                              : limit_[lane] ? StepStatus::pass_limit
                                             : StepStatus::converged;
    return {status, static_cast<int>(-passes_[lane])};
  }

 private:
  using Store = Storage<Wide, MassOf, Rods>;
  using V = typename Store::V;
  using Mask = typename Lanes<Wide>::Mask;

  void mark(int chain, double tolerance, long long running) {
    for (int lane = 2 * chain; lane < 2 * chain + 2; ++lane) {
      tolerance_[lane] = tolerance;
      running_[lane] = running;
    }
  }
  /// What holds in both lanes of a chain.
  static Mask both(const Mask& mask) {
    Mask result{};
    for (int lane = 0; lane < 2 * kChains; ++lane) result[lane] = mask[lane] & mask[lane ^ 1];
    return result;
  }
  static bool any(const Mask& mask) {
    long long bits = 0;
    for (int lane = 0; lane < 2 * kChains; ++lane) bits |= mask[lane];
    return bits != 0;
  }

  StepSettings settings_;
  Store chain_;
  V tolerance_{};
  Mask running_{};
  int until_projection_ = 1;
  Projections projections_ = Projections::both;

  // of the present step
  PassResult<V> result_{};
  Mask active_{};      // which chains take part in the next pass
  Mask last_{};        // which took part in the last one
  Mask passes_{};      // the negative of their number
  Mask failed_{};      // which have no factors
  Mask limit_{};       // which stopped at the limit
  bool whole_ = true;  // all took part in all passes
  bool more_ = true;   // another pass is to be done
  int pass_ = 1;
};

}  // namespace mbs::compiled_ldl::chain
