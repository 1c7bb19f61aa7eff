// Many chains of one shape at once: the same sweeps in wider registers, with masks.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "chain_lane_group.hpp"
#include "mbs/batch.hpp"

namespace mbs::compiled_ldl::chain {

template <template <class> class MassOf, class Rods>
class PenaltyBatch final : public BatchSimulation {
 public:
  PenaltyBatch(std::span<const Model* const> models, std::span<const StepSettings> settings,
               std::vector<Topology> topologies)
      : BatchSimulation(models, settings),
        settings_(settings.begin(), settings.end()),
        topologies_(std::move(topologies)) {
    const int places = static_cast<int>(topologies_[0].places.size());
    for (int first = 0; first < lanes(); first += Group::kChains) {
      groups_.push_back(std::make_unique<Group>(places, settings_[0]));
    }
    const std::size_t fitting = kFirstLevelCache / groups_[0]->bytes();
    together_ = std::clamp<std::size_t>(fitting, 1, kMostTogether);
  }

 private:
  using Group = LaneGroup<MassOf, Rods>;
  static constexpr std::size_t kFirstLevelCache = 40000;  // bytes of it that blocks may take
  static constexpr std::size_t kMostTogether = 4;

  void do_set_state(int lane, const State& state) override {
    group(lane).set(lane % Group::kChains, topologies_[lane], settings_[lane], state);
  }
  void do_get_state(int lane, State& state) const override {
    groups_[lane / Group::kChains]->get(lane % Group::kChains, topologies_[lane], settings_[lane],
                                        state);
  }
  void do_retire(int lane) override { group(lane).clear(lane % Group::kChains); }

  void do_step(std::span<StepOutcome> outcomes) override {
    for (std::size_t first = 0; first < groups_.size(); first += together_) {
      const std::size_t count = std::min(together_, groups_.size() - first);
      step_together({groups_.data() + first, count});
    }
    for (int lane = 0; lane < lanes(); ++lane) {
      outcomes[lane] = group(lane).outcome(lane % Group::kChains);
    }
  }

  /// Sweeps of a few groups by turns: while one waits at the end of a sweep for the number that the
  /// next one begins with, the processor has another's to do.
  static void step_together(std::span<const std::unique_ptr<Group>> groups) {
    for (const auto& group : groups) group->first_inwards();
    for (const auto& group : groups) group->first_outwards();
    for (bool more = true; more;) {
      more = false;
      for (const auto& group : groups) more = group->decide() || more;
      for (const auto& group : groups) group->inwards();
      for (const auto& group : groups) group->outwards();
    }
    for (const auto& group : groups) group->velocity_inwards();
    for (const auto& group : groups) group->velocity_outwards();
    for (const auto& group : groups) group->acceleration_inwards();
    for (const auto& group : groups) group->acceleration_outwards();
  }

  Group& group(int lane) { return *groups_[lane / Group::kChains]; }

  std::vector<StepSettings> settings_;
  std::vector<Topology> topologies_;
  std::vector<std::unique_ptr<Group>> groups_;
  std::size_t together_ = 1;
};

}  // namespace mbs::compiled_ldl::chain
