// Many chains of one shape at once: the same sweeps in wider registers, with masks.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "mbs/batch.hpp"
#include "storage.hpp"

namespace mbs::compiled_chains {

using WideMask = Lanes<Wide>::Mask;

/// The chains for which a comparison holds in both lanes.
template <class Comparison>
WideMask where(const Comparison& comparison) {
  const auto lanes = (WideMask)comparison;
  return lanes & Lanes<Wide>::other_end(lanes);
}

inline bool any(const WideMask& mask) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
#endif
  long long bits = 0;
  for (int lane = 0; lane < kRegisterDoubles; ++lane) bits |= mask[lane];
  return bits != 0;
}

/// What the batches of all schemes have in common. A lane without a chain is at rest. Five chains
/// in registers of eight doubles are two groups with kChains = 4: in the second one lanes 0 and 1,
/// the two ends of the fifth chain, have running_ = −1, all others 0.
template <class Store>
class LaneGroup {
 public:
  static constexpr int kChains = Lanes<Wide>::kChains;

  LaneGroup(int places, const StepSettings& settings) : settings_(settings), chain_(places) {
    for (int chain = 0; chain < kChains; ++chain) clear(chain);
  }
  [[nodiscard]] std::size_t bytes() const { return chain_.bytes(); }

  void set_state(int chain, const Topology& topology, const StepSettings& settings,
                 const State& state) {
    const Units units(settings, topology);
    chain_.set_constants(chain, topology, units);
    chain_.set_state(chain, topology, units, state);
    mark(chain, 2.0 * units.length * settings.tolerance, -1);
    steps_ = 0;
  }
  void clear(int chain) {
    chain_.clear(chain);
    mark(chain, 1.0, 0);
  }

  [[nodiscard]] StepOutcome outcome(int chain) const {
    const int lane = 2 * chain;
    const StepStatus status = failed_[lane]  ? StepStatus::factorization_failed
                              : limit_[lane] ? StepStatus::pass_limit
                                             : StepStatus::converged;
    return {status, static_cast<int>(-passes_[lane]), factorizations_};
  }

 protected:
  using V = typename Store::V;

  StepSettings settings_;
  mutable Store chain_;  // RATTLE completes λ when somebody asks for it
  V tolerance_{};        // of |2 s Δq|
  WideMask running_{};   // which chains there are
  long steps_ = 0;       // since the state was set

  // of the present step
  WideMask passes_{};  // the negative of their number
  WideMask failed_{};  // which chains have no factors
  WideMask limit_{};   // which stopped at the limit
  int factorizations_ = -1;

 private:
  void mark(int chain, double tolerance, long long running) {
    for (int lane = 2 * chain; lane < 2 * chain + 2; ++lane) {
      tolerance_[lane] = tolerance;
      running_[lane] = running;
    }
  }
};

/// In groups of as many as a register has room for.
template <class Group>
class ChainBatch final : public BatchSimulation {
 public:
  ChainBatch(std::span<const Model* const> models, std::span<const StepSettings> settings,
             std::vector<Topology> topologies)
      : BatchSimulation(models, settings),
        settings_(settings.begin(), settings.end()),
        topologies_(std::move(topologies)) {
    const int places = static_cast<int>(topologies_[0].places.size());
    for (int first = 0; first < lanes(); first += Group::kChains) {
      groups_.push_back(std::make_unique<Group>(places, settings_[0]));
    }
    const std::size_t fitting = kFittingBytes / groups_[0]->bytes();
    together_ = std::clamp<std::size_t>(fitting, 1, kMostTogether);
  }

 private:
  /// Larger groups are quicker one after the other.
  static constexpr std::size_t kFittingBytes = 65000;
  static constexpr std::size_t kMostTogether = 2;

  void do_set_state(int lane, const State& state) override {
    group(lane).set_state(lane % Group::kChains, topologies_[lane], settings_[lane], state);
  }
  void do_get_state(int lane, State& state) const override {
    groups_[lane / Group::kChains]->get_state(lane % Group::kChains, topologies_[lane],
                                              settings_[lane], state);
  }
  void do_retire(int lane) override { group(lane).clear(lane % Group::kChains); }

  void do_step(std::span<StepOutcome> outcomes) override {
    for (std::size_t first = 0; first < groups_.size(); first += together_) {
      const std::size_t count = std::min(together_, groups_.size() - first);
      Group::step_together({groups_.data() + first, count});
    }
    for (int lane = 0; lane < lanes(); ++lane) {
      outcomes[lane] = group(lane).outcome(lane % Group::kChains);
    }
  }

  Group& group(int lane) { return *groups_[lane / Group::kChains]; }

  std::vector<StepSettings> settings_;
  std::vector<Topology> topologies_;
  std::vector<std::unique_ptr<Group>> groups_;
  std::size_t together_ = 1;
};

}  // namespace mbs::compiled_chains
