// mbs sweep: one scene with many parameter sets, a typed outcome each.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "mbs/commands.hpp"
#include "mbs/file_names.hpp"
#include "mbs/progress.hpp"
#include "mbs/sweep_file.hpp"
#include "scene/not_assembled.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr const char* kVary =
    "a number of the scene and its values, repeatable (the full grid, the last varies fastest). "
    "PATH: keys, and items by name or index, as springs/s/stiffness, points/B/velocity/0, "
    "gravity/1 (in names ~1 stands for /). RANGE: a:b:K (K values from a to b), a:b:K:log, or "
    "v1,v2,...";

struct SweepOptions {
  std::string scene;
  std::vector<std::string> vary;
  std::string implementation;
  StepOptions step;
  double duration = 20.0;
  bool half_step = false;
  std::string output;
};

/// The status of a lane whose start cannot be assembled.
constexpr const char* kNotAssembled = "not-assembled";

/// How many lanes ended how.
struct Outcomes {
  std::map<RunStatus, long> simulated;
  long not_assembled = 0;
  bool alone = false;  // whether lanes that fit together ran one after the other

  [[nodiscard]] long failed() const {
    long count = not_assembled;
    for (const auto& [status, lanes] : simulated) {
      if (!is_finished(status)) count += lanes;
    }
    return count;
  }
  /// "5 ok, 1 diverged".
  [[nodiscard]] std::string text() const {
    std::vector<std::string> parts;
    for (const auto& [status, lanes] : simulated) {
      parts.push_back(fmt::format("{} {}", lanes, to_string(status)));
    }
    if (not_assembled > 0) parts.push_back(fmt::format("{} {}", not_assembled, kNotAssembled));
    return fmt::format("{}", fmt::join(parts, ", "));
  }
};

std::string lanes_text(long lanes) {
  return fmt::format("{} lane{}", lanes, lanes == 1 ? "" : "s");
}

/// Throws UsageError if they do not go with `scene`.
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

/// Throws NotAssembled, and UsageError with the lane's values for what makes no scene.
Lane prepare(const SweepOptions& options, const SweepGrid& grid, long index) {
  try {
    Scene scene = grid.scene(index);
    const RunSettings settings = resolve(options, scene);
    return {std::move(scene), settings};
  } catch (const NotAssembled&) {
    throw;
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", grid.describe(index), error.what()));
  }
}

/// A value that makes no scene is bad input: found before anything runs. Lanes are made anew when
/// they run, since a million of them would not fit into memory.
void require_lanes(const SweepOptions& options, const SweepGrid& grid) {
  Progress progress(static_cast<double>(grid.lanes()), "lanes checked");
  for (long i = 0; i < grid.lanes(); ++i) {
    progress.at(static_cast<double>(i));
    try {
      prepare(options, grid, i);
    } catch (const NotAssembled&) {  // a lane's own outcome
    }
  }
}

/// Runs all lanes, neighbours that fit together at once, and writes their rows in order.
Outcomes run_grid(const SweepOptions& options, const SweepGrid& grid, const Variant& variant,
                  SweepFile& file) {
  Outcomes outcomes;
  Progress progress(static_cast<double>(grid.lanes()), "lanes");
  std::vector<Lane> group;
  long written = 0;
  const auto finish_group = [&] {
    const bool side_by_side = run_lanes(
        group, variant, [&](double done) { progress.at(static_cast<double>(written) + done); });
    outcomes.alone |= group.size() > 1 && !side_by_side;
    for (const Lane& lane : group) {
      file.write(grid.values(written++), lane);
      ++outcomes.simulated[lane.summary.status];
    }
    group.clear();
  };
  for (long i = 0; i < grid.lanes(); ++i) {
    try {
      Lane lane = prepare(options, grid, i);
      const bool fits = group.size() < lanes_at_once(variant) &&
                        (group.empty() || fit_one_batch(group.front(), lane));
      if (!fits) finish_group();
      group.push_back(std::move(lane));
    } catch (const NotAssembled& error) {
      finish_group();
      file.write_failed(grid.values(written++), kNotAssembled, error.what());
      ++outcomes.not_assembled;
    }
  }
  finish_group();
  return outcomes;
}

int sweep(const SweepOptions& options) {
  const NamedVariant variant = select_variant(options.implementation);
  require_not_scene("--output", options.output, options.scene);
  const SweepGrid grid(options.scene, options.vary);
  resolve(options, grid.base());  // what is wrong with the options is not said of a lane
  SweepFile file(options.output, grid);
  require_lanes(options, grid);
  const Outcomes outcomes = run_grid(options, grid, *variant.variant, file);
  file.commit();
  if (outcomes.alone) {
    fmt::print(stderr,
               "mbs: note: lanes ran one after the other: {} takes this scene with these settings "
               "only so\n",
               variant.name);
  }
  if (outcomes.failed() == 0) {
    fmt::print("{}: {}\n", lanes_text(grid.lanes()), outcomes.text());
    return 0;
  }
  fmt::print(stderr, "mbs: {} on {}: {} of {} failed: {} (column status_reason says why)\n",
             variant.name, grid.base().name, outcomes.failed(), lanes_text(grid.lanes()),
             outcomes.text());
  return 1;
}

}  // namespace

void add_sweep_command(CLI::App& app, int& status) {
  auto* command =
      app.add_subcommand("sweep", "simulate a scene with many parameter sets, for what-if studies");
  const auto options = std::make_shared<SweepOptions>();
  command->add_option("scene", options->scene, "the scene")->required();
  command->add_option("--vary", options->vary, kVary)
      ->required()
      ->allow_extra_args(false)
      ->type_name("PATH=RANGE");
  command->add_option("--implementation", options->implementation, "folder/variant (see mbs list)")
      ->required();
  options->step.add_to(*command);
  command->add_option("--duration", options->duration, "simulated time, s, rounded to whole steps")
      ->capture_default_str();
  command->add_flag("--half-step", options->half_step,
                    "also simulate with half the step, and estimate the error by the difference");
  command
      ->add_option("--output", options->output,
                   "CSV file: a row a lane, with its values, outcome, figures, and last, least and "
                   "largest value of each of the scene's \"outputs\"")
      ->required();
  command->callback([options, &status] { status = sweep(*options); });
}

}  // namespace mbs
