// A block is prepared to check it, and again to run it if it is not held: a million lanes would not
// fit into memory.
#include "mbs/sweep_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "mbs/sweep_outcomes.hpp"
#include "scene/not_assembled.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

/// How many lanes a process holds. A scene takes up to ten times the bytes of its document.
std::size_t most_lanes(const SweepOptions& options, const SweepGrid& grid) {
  constexpr std::size_t kHeld = std::size_t{256} << 20;  // bytes, of all processes
  if (options.check) return 0;
  return kHeld / (10 * grid.document().dump().size()) / static_cast<std::size_t>(options.jobs);
}

}  // namespace

RunSettings resolve(const SweepOptions& options, const Scene& scene) {
  RunSettings settings;
  settings.step = options.step.resolve(scene.model);
  settings.duration = options.duration;
  if (options.half_step) {
    StepOptions half = options.step;
    half.settings.step /= 2;
    settings.half_step = half.resolve(scene.model);
  }
  require_duration(scene, settings);
  return settings;
}

SweepBlocks::SweepBlocks(const SweepOptions& options, const SweepGrid& grid, const Variant& variant)
    : options_(options),
      grid_(grid),
      variant_(variant),
      rows_(grid),
      size_(static_cast<long>(lanes_at_once(variant))),
      most_held_(most_lanes(options, grid) / static_cast<std::size_t>(size_)) {}

long SweepBlocks::end_of(long block) const { return std::min((block + 1) * size_, grid_.lanes()); }

long SweepBlocks::lanes(const std::vector<long>& blocks) const {
  long count = 0;
  for (const long block : blocks) count += end_of(block) - block * size_;
  return count;
}

/// Throws UsageError with the lane's values for what makes no scene.
SweepBlocks::Prepared SweepBlocks::prepare(long index) const {
  try {
    Scene scene = grid_.scene(index);
    const RunSettings settings = resolve(options_, scene);
    return {Lane{std::move(scene), settings}};
  } catch (const NotAssembled& error) {  // a lane's own outcome
    return {std::nullopt, error.what()};
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", grid_.describe(index), error.what()));
  }
}

std::vector<SweepBlocks::Prepared> SweepBlocks::prepare_all(long block) const {
  std::vector<Prepared> lanes;
  for (long i = block * size_; i < end_of(block); ++i) lanes.push_back(prepare(i));
  return lanes;
}

void SweepBlocks::check(long block) {
  std::vector<Prepared> lanes = prepare_all(block);
  if (held_.size() < most_held_) held_.emplace(block, std::move(lanes));
}

std::string SweepBlocks::run(long block) {
  auto held = held_.extract(block);
  std::vector<Prepared> lanes = held ? std::move(held.mapped()) : prepare_all(block);
  Outcomes outcomes;
  std::string rows;
  std::vector<Lane> group;
  long written = block * size_;
  const auto finish_group = [&] {
    const bool side_by_side = run_lanes(group, variant_);
    outcomes.alone |= group.size() > 1 && !side_by_side;
    for (const Lane& lane : group) {
      rows += rows_.row(grid_.values(written++), lane);
      ++outcomes.simulated[lane.summary.status];
    }
    group.clear();
  };
  for (auto& [lane, not_assembled] : lanes) {
    if (!lane || (!group.empty() && !fit_one_batch(group.front(), *lane))) finish_group();
    if (lane) {
      group.push_back(*std::move(lane));
    } else {
      rows += rows_.failed_row(grid_.values(written++), kNotAssembled, not_assembled);
      ++outcomes.not_assembled;
    }
  }
  finish_group();
  return outcomes.to_json().dump() + '\n' + rows;
}

}  // namespace mbs
