// Checks all blocks, runs those that the journal lacks, then writes the table.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <vector>

#include "atomic_file.hpp"
#include "environment/environment.hpp"
#include "mbs/file_names.hpp"
#include "mbs/progress.hpp"
#include "mbs/sweep_blocks.hpp"
#include "mbs/sweep_parts.hpp"
#include "printable.hpp"
#include "sweep/job_pool.hpp"
#include "sweep/value_range.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

namespace fs = std::filesystem;

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
    throw UsageError(
        fmt::format("--shard: found {}, allowed is i/K with i from 1 to K", in_quotes(text)));
  }
  --shard.index;
  return shard;
}

/// Looks at the lanes only: a value that makes no scene is bad input.
void check_lanes(int jobs, const std::vector<long>& mine, SweepBlocks& blocks) {
  Progress progress(static_cast<double>(mine.size()), "blocks of lanes checked");
  const auto check = [&](long block) {
    blocks.check(block);
    return std::string();
  };
  for_blocks(
      jobs, mine, check, [](long, const std::string&) {},
      [&](std::size_t, std::size_t done) { progress.at(static_cast<double>(done)); });
}

/// Whether rows can be kept beside it until it is written, so that a sweep can go on.
bool is_file(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return !is_open_already(path) && !path.starts_with("/proc/") &&
         (!fs::exists(status) || fs::is_regular_file(status));
}

/// Whether it was ended before anything was done.
bool has_no_blocks(const std::string& path) {
  try {
    const Journal journal(path);
    return journal.size() == 0 && !journal.damage();
  } catch (const UsageError&) {  // another file
    return false;
  }
}

/// Before anything else: nobody loses by forgetting --resume what hours have given.
void require_no_other(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_busy = file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (file >= 0) ::close(file);
  if (is_busy) {
    throw UsageError(
        fmt::format("{}: another mbs sweep is writing it", printable(path, kLongestPath)));
  }
  if (has_no_blocks(path) && fs::remove(path, ignored)) return;
  throw UsageError(
      fmt::format("{}: found a sweep that was ended, allowed is to go on with --resume, or to "
                  "remove it",
                  printable(path, kLongestPath)));
}

/// To go on with: what was done if it is of this sweep, or a new one. `kept`: where.
Journal open_journal(const std::string& output, const std::string& kept,
                     const nlohmann::json& head) {
  if (!is_file(output)) {  // a pipe, a device: kept where nobody finds it
    std::string path = (fs::temp_directory_path() / "mbs-sweep-XXXXXX").string();
    const int file = ::mkstemp(path.data());
    if (file >= 0) ::close(file);
    Journal journal(path, head);
    fs::remove(path);
    return journal;
  }
  Journal journal(kept, head);  // nobody else writes this table
  require_same_sweep(journal, head);
  return journal;
}

nlohmann::json head_of(const SweepOptions& options, const SweepGrid& grid,
                       const std::string& variant, const SweepBlocks& blocks, const Shard& shard) {
  const EnvironmentRecord record = environment_record();
  const auto recorded = [&record](const char* name) {
    return std::ranges::find(record, name, &EnvironmentRecord::value_type::first)->second;
  };
  const auto text = [](const std::string& bytes) { return printable(bytes, std::string::npos); };
  return {{"scene", text(grid.base().name)},
          {"implementation", variant},
          {"options", text(options.identity)},
          {"file", checksum(grid.document().dump())},
          {"program", program_checksum()},
          {"libraries", recorded("libraries") + "; " + recorded("blas_loaded")},
          {"processor", recorded("cpu_model")},
          {"columns", blocks.rows().head()},
          {"lanes", grid.lanes()},
          {"blocks", blocks.count()},
          {"shard", {shard.index + 1, shard.count}}};
}

/// A value that makes no scene is found before anything runs; if something did, all were looked at.
void run_blocks(int jobs, const std::vector<long>& mine, SweepBlocks& blocks, Journal& journal) {
  std::vector<long> open;
  for (const long block : mine) {
    if (!journal.has(block)) open.push_back(block);
  }
  if (journal.damage() && !open.empty()) {
    fmt::print(
        stderr,
        "mbs: note: {}: damaged or changed at byte {}: {} of {} blocks are there, the others "
        "are run\n",
        printable(journal.path(), kLongestPath), *journal.damage(), mine.size() - open.size(),
        mine.size());
  }
  const std::size_t before = journal.size();
  Progress checked(static_cast<double>(mine.size()), "blocks of lanes checked");
  Progress run(static_cast<double>(mine.size()), "blocks of lanes");
  std::function<void(long)> check;
  if (before == 0) check = [&](long block) { blocks.check(block); };
  for_blocks(
      jobs, open, [&](long block) { return blocks.run(block); },
      [&](long block, const std::string& rows) { journal.add(block, rows); },
      [&](std::size_t prepared, std::size_t kept) {
        const bool is_running = kept > 0 || prepared == 0;
        (is_running ? run : checked).at(static_cast<double>(is_running ? before + kept : prepared));
      },
      check);
  journal.scan();
}

/// The same; a journal without a block is nothing to go on with.
void run_or_remove(int jobs, const std::vector<long>& mine, SweepBlocks& blocks, Journal& journal) {
  try {
    run_blocks(jobs, mine, blocks, journal);
  } catch (...) {
    journal.scan();
    std::error_code ignored;
    if (journal.size() == 0) fs::remove(journal.path(), ignored);
    throw;
  }
}

}  // namespace

int sweep(const SweepOptions& options) {
  const NamedVariant variant = select_variant(options.implementation);
  require_not_scene("--output", options.output, options.scene);
  const Shard shard = parse_shard(options.shard);
  const SweepGrid grid(options.scene, options.vary, options.sampling);
  // What is wrong with the options is not said of a lane.
  const StepSettings settings = resolve(options, grid.base()).step;
  SweepBlocks blocks(options, grid, *variant.variant);
  std::vector<long> mine;
  for (long block = shard.index; block < blocks.count(); block += shard.count)
    mine.push_back(block);
  if (options.check) {
    check_lanes(options.jobs, mine, blocks);
    const long lanes = blocks.lanes(mine);
    fmt::print("{} lane{}: no value is refused\n", lanes, lanes == 1 ? "" : "s");
    return 0;
  }
  const nlohmann::json head = head_of(options, grid, variant.name, blocks, shard);
  const bool is_part = !options.shard.empty();
  if (is_part && !is_file(options.output)) {
    throw UsageError(
        "--output: found a device or a pipe, allowed with --shard is a file, for mbs merge-sweep");
  }
  std::error_code ignored;
  const bool is_made = is_part && fs::exists(options.output, ignored);
  if (is_made) {
    if (!options.resume) {
      throw UsageError(
          fmt::format("{}: found a file, allowed with --shard is a new one, or --resume",
                      printable(options.output, kLongestPath)));
    }
    if (fs::file_size(options.output, ignored) > 0) {
      const Journal done(options.output);
      require_same_sweep(done, head);
      if (has_all_blocks(done)) return finish_part(done);
    }
  }
  static_cast<void>(AtomicFile(options.output));  // says at once what cannot be written
  // A part that was cut or damaged since is mended where it is.
  const std::string kept = is_made ? options.output : options.output + ".journal";
  if (!options.resume) require_no_other(kept);
  if (options.resume && !is_part && is_file(options.output) &&
      fs::exists(options.output, ignored) && !fs::exists(kept, ignored)) {
    throw UsageError(
        fmt::format("{}: found a table and no sweep that was ended, allowed is the same without "
                    "--resume, which makes it anew",
                    printable(options.output, kLongestPath)));
  }
  print_warnings(grid.base().name, options.step.warnings(grid.base().model, settings));
  Journal journal = open_journal(options.output, kept, head);
  run_or_remove(options.jobs, mine, blocks, journal);
  if (is_part) {
    if (!is_made) fs::rename(journal.path(), options.output);
    return finish_part(journal);
  }
  const int status = write_table({&journal}, options.output);
  fs::remove(journal.path(), ignored);
  return status;
}

}  // namespace mbs
