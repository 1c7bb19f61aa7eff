// mbs sweep: one scene with many parameter sets, a typed outcome each.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>

#include "mbs/commands.hpp"
#include "mbs/file_names.hpp"
#include "mbs/progress.hpp"
#include "mbs/sweep_outcomes.hpp"
#include "mbs/sweep_parts.hpp"
#include "mbs/sweep_rows.hpp"
#include "mbs/table_file.hpp"
#include "printable.hpp"
#include "scene/not_assembled.hpp"
#include "sweep/job_pool.hpp"
#include "sweep/journal.hpp"
#include "sweep/value_range.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr const char* kVary =
    "a number of the scene and its values, repeatable (the full grid, the last varies fastest). "
    "PATH: keys, and items by name or index, as springs/s/stiffness, points/B/velocity/0, "
    "gravity/1 (in names ~1 stands for /), or the name of a parameter. RANGE: a:b:K (K values from "
    "a to b), a:b:K:log, or v1,v2,...; with --sample uniform:a:b or normal:mean:deviation";

struct SweepOptions {
  std::string scene;
  std::vector<std::string> vary;
  std::string implementation;
  StepOptions step;
  double duration = 20.0;
  bool half_step = false;
  Sampling sampling;
  int jobs = 1;
  std::string shard;
  bool resume = false;
  std::string output;
  std::string identity;  // all options that the rows depend on
};

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

/// Which of how many parts, from 0.
struct Shard {
  long index = 0, count = 1;
};

Shard parse_shard(const std::string& text) {
  if (text.empty()) return {};
  Shard shard;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, shard.index);
  bool ok = first.ec == std::errc{} && first.ptr != end && *first.ptr == '/';
  if (ok) {
    const auto second = std::from_chars(first.ptr + 1, end, shard.count);
    ok = second.ec == std::errc{} && second.ptr == end;
  }
  if (!ok || shard.index < 1 || shard.index > shard.count || shard.count > kMostLanes) {
    throw UsageError(fmt::format("--shard: found {}, allowed is i/K with i from 1 to K", in_quotes(text)));
  }
  --shard.index;
  return shard;
}

/// Runs the lanes of blocks; a block is what goes side by side, so that rows do not depend on who
/// runs it.
class Blocks {
 public:
  Blocks(const SweepOptions& options, const SweepGrid& grid, const Variant& variant)
      : options_(options), grid_(grid), variant_(variant), rows_(grid),
        size_(static_cast<long>(lanes_at_once(variant))) {}

  [[nodiscard]] const SweepRows& rows() const { return rows_; }
  [[nodiscard]] long size() const { return size_; }
  [[nodiscard]] long count() const { return (grid_.lanes() + size_ - 1) / size_; }
  [[nodiscard]] long end_of(long block) const { return std::min((block + 1) * size_, grid_.lanes()); }

  /// What is wrong with the first lane that makes no scene; empty if all do.
  [[nodiscard]] std::string check(long block) const {
    for (long i = block * size_; i < end_of(block); ++i) {
      try {
        prepare(options_, grid_, i);
      } catch (const NotAssembled&) {  // a lane's own outcome
      } catch (const UsageError& error) {
        return error.what();
      }
    }
    return "";
  }

  /// A line of outcomes, then the rows.
  [[nodiscard]] std::string run(long block) const {
    Outcomes outcomes;
    std::string rows;
    std::vector<Lane> group;
    long written = block * size_;
    const auto finish_group = [&] {
      const bool side_by_side = run_lanes(group, variant_, [](double) {});
      outcomes.alone |= group.size() > 1 && !side_by_side;
      for (const Lane& lane : group) {
        rows += rows_.row(grid_.values(written++), lane);
        ++outcomes.simulated[lane.summary.status];
      }
      group.clear();
    };
    for (long i = written; i < end_of(block); ++i) {
      try {
        Lane lane = prepare(options_, grid_, i);
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

 private:
  const SweepOptions& options_;
  const SweepGrid& grid_;
  const Variant& variant_;
  SweepRows rows_;
  long size_;
};

/// A value that makes no scene is bad input: found before anything runs. Lanes are made anew when
/// they run, since a million of them would not fit into memory.
void require_lanes(int jobs, const std::vector<long>& mine, const Blocks& blocks) {
  Progress progress(static_cast<double>(mine.size()), "blocks of lanes checked");
  std::map<long, std::string> faults;
  double done = 0.0;
  for_blocks(jobs, mine, [&](long block) { return blocks.check(block); },
             [&](long block, const std::string& fault) {
               progress.at(++done);
               if (!fault.empty()) faults.emplace(block, fault);
               return faults.empty();
             });
  if (!faults.empty()) throw UsageError(faults.begin()->second);
}

/// The journal to go on with: what was done if it is of this sweep, or a new one.
Journal open_journal(const std::string& path, const nlohmann::json& head, bool resume) {
  std::error_code ignored;
  if (!resume || !std::filesystem::exists(path, ignored)) return {path, head};
  Journal journal(path);
  require_same_sweep(journal, head);
  journal.open();
  return journal;
}

int sweep(const SweepOptions& options) {
  const NamedVariant variant = select_variant(options.implementation);
  require_not_scene("--output", options.output, options.scene);
  const Shard shard = parse_shard(options.shard);
  const SweepGrid grid(options.scene, options.vary, options.sampling);
  resolve(options, grid.base());  // what is wrong with the options is not said of a lane
  const Blocks blocks(options, grid, *variant.variant);
  std::vector<long> mine;
  for (long block = shard.index; block < blocks.count(); block += shard.count) mine.push_back(block);
  const nlohmann::json head{{"scene", grid.base().name},
                            {"implementation", variant.name},
                            {"options", options.identity},
                            {"file", checksum(grid.document().dump())},
                            {"program", program_checksum()},
                            {"columns", blocks.rows().head()},
                            {"lanes", grid.lanes()},
                            {"blocks", blocks.count()},
                            {"shard", {shard.index + 1, shard.count}}};
  const bool is_part = !options.shard.empty();
  std::error_code ignored;
  if (is_part && options.resume && std::filesystem::exists(options.output, ignored)) {
    const Journal done(options.output);
    require_same_sweep(done, head);
    return finish_part(done);
  }
  std::optional<TableFile> table;  // says at once what cannot be written
  if (is_part) {
    AtomicFile(options.output);
  } else {
    table.emplace(options.output);
  }
  const std::string path = options.output + ".journal";
  if (!options.resume || !std::filesystem::exists(path, ignored)) {
    require_lanes(options.jobs, mine, blocks);
  }
  Journal journal = open_journal(path, head, options.resume);
  std::vector<long> open;
  for (const long block : mine) {
    if (!journal.has(block)) open.push_back(block);
  }
  {
    Progress progress(static_cast<double>(mine.size()), "blocks of lanes");
    for_blocks(options.jobs, open, [&](long block) { return blocks.run(block); },
               [&](long block, const std::string& text) {
                 journal.add(block, text);
                 progress.at(static_cast<double>(journal.size()));
                 return true;
               });
  }
  if (is_part) {
    std::filesystem::rename(path, options.output);
    return finish_part(journal);
  }
  const std::vector<const Journal*> parts{&journal};
  const int status = write_table(parts, *table);
  std::filesystem::remove(path, ignored);
  return status;
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
  command->add_option("--sample", options->sampling.count,
                      "as many random lanes, for each point of the grid of what is not sampled")
      ->check(CLI::Range(1L, kMostLanes));
  command->add_option("--seed", options->sampling.seed, "of --sample")->capture_default_str();
  command->add_flag("--sobol", options->sampling.sobol,
                    "sample by a Sobol sequence, shifted by the seed, instead of at random");
  std::vector<CLI::Option*> apart;  // what the rows do not depend on
  apart.push_back(command
                      ->add_option("--jobs", options->jobs, "processes that run lanes side by side")
                      ->check(CLI::Range(1, 1024))
                      ->capture_default_str());
  apart.push_back(command
                      ->add_option("--shard", options->shard,
                                   "only the i-th of K parts, for mbs merge-sweep")
                      ->type_name("i/K"));
  apart.push_back(command->add_flag("--resume", options->resume,
                                    "go on where the same sweep was ended (OUTPUT.journal)"));
  apart.push_back(command
      ->add_option("--output", options->output,
                   "CSV file, compressed if it ends in .gz: a row a lane, with its values, outcome, figures, and last, least and "
                   "largest value of each of the scene's \"outputs\"")
      ->required());
  for (CLI::Option* option : apart) option->configurable(false);
  command->callback([options, command, &status] {
    options->identity = command->config_to_str(/*default_also=*/true);
    status = sweep(*options);
  });
}

void add_merge_sweep_command(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("merge-sweep", "one table of the parts of mbs sweep --shard");
  const auto parts = std::make_shared<std::vector<std::string>>();
  const auto output = std::make_shared<std::string>();
  command->add_option("parts", *parts, "all parts, in any order")->required();
  command->add_option("--output", *output, "the table, as of mbs sweep")->required();
  command->callback([parts, output, &status] { status = merge_sweep(*parts, *output); });
}

}  // namespace mbs
