// A block is prepared twice, to check it and to run it: a million lanes would not fit into memory.
#include "mbs/sweep_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "mbs/sweep_outcomes.hpp"
#include "scene/not_assembled.hpp"
#include "usage_error.hpp"

namespace mbs {

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
      size_(static_cast<long>(lanes_at_once(variant))) {}

long SweepBlocks::end_of(long block) const { return std::min((block + 1) * size_, grid_.lanes()); }

long SweepBlocks::lanes(const std::vector<long>& blocks) const {
  long count = 0;
  for (const long block : blocks) count += end_of(block) - block * size_;
  return count;
}

/// Throws NotAssembled, and UsageError with the lane's values for what makes no scene.
Lane SweepBlocks::prepare(long index) const {
  try {
    Scene scene = grid_.scene(index);
    const RunSettings settings = resolve(options_, scene);
    return {std::move(scene), settings};
  } catch (const NotAssembled&) {
    throw;
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", grid_.describe(index), error.what()));
  }
}

void SweepBlocks::check(long block) const {
  for (long i = block * size_; i < end_of(block); ++i) {
    try {
      static_cast<void>(prepare(i));
    } catch (const NotAssembled&) {  // a lane's own outcome
    }
  }
}

std::string SweepBlocks::run(long block) const {
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
  for (long i = written; i < end_of(block); ++i) {
    try {
      Lane lane = prepare(i);
      if (!group.empty() && !fit_one_batch(group.front(), lane)) finish_group();
      group.push_back(std::move(lane));
    } catch (const NotAssembled& error) {
      finish_group();
      rows += rows_.failed_row(grid_.values(written++), kNotAssembled, error.what());
      ++outcomes.not_assembled;
    }
  }
  finish_group();
  return outcomes.to_json().dump() + '\n' + rows;
}

}  // namespace mbs
