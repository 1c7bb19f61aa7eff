// Many chains of one shape at once: the same sweeps in wider registers, with masks.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "chain_topology.hpp"
#include "mbs/batch.hpp"

namespace mbs::compiled_ldl::chain {

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

}  // namespace mbs::compiled_ldl::chain
