// Checks all blocks, runs those that the journal lacks, then writes the table.
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <vector>

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
    throw UsageError(fmt::format("--shard: found {}, allowed is i/K with i from 1 to K", in_quotes(text)));
  }
  --shard.index;
  return shard;
}

/// A value that makes no scene is bad input: found before anything runs.
void require_lanes(int jobs, const std::vector<long>& mine, const SweepBlocks& blocks) {
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

/// Whether rows can be kept beside it until it is written, so that a sweep can go on.
bool is_file(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return !path.starts_with("/dev/") && !path.starts_with("/proc/") &&
         (!fs::exists(status) || fs::is_regular_file(status));
}

/// Before anything else: nobody loses by forgetting --resume what hours have given.
void require_no_other(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  throw UsageError(fmt::format("{}: found a sweep that was ended, allowed is to go on with --resume, or to "
                               "remove it",
                               printable(path, kLongestPath)));
}

/// What was left beside `path` by a process that was killed while it wrote the table.
void remove_partial(const std::string& path) {
  std::error_code ignored;
  const fs::path table = fs::weakly_canonical(fs::absolute(path), ignored);
  const std::string begin = table.filename().string() + ".", end = ".partial";
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(table.parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= begin.size() + end.size() || !name.starts_with(begin) || !name.ends_with(end)) continue;
    const std::string between = name.substr(begin.size(), name.size() - begin.size() - end.size());
    if (between.find_first_not_of("0123456789-") == std::string::npos) left.push_back(entry.path());
  }
  for (const fs::path& file : left) fs::remove(file, ignored);
}

/// To go on with: what was done if it is of this sweep, or a new one.
Journal open_journal(const std::string& output, const nlohmann::json& head) {
  if (!is_file(output)) {  // a pipe, a device: kept where nobody finds it
    std::string path = (fs::temp_directory_path() / "mbs-sweep-XXXXXX").string();
    const int file = ::mkstemp(path.data());
    if (file >= 0) ::close(file);
    Journal journal(path, head);
    fs::remove(path);
    return journal;
  }
  const std::string path = output + ".journal";
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {path, head};
  Journal journal(path);
  require_same_sweep(journal, head);
  journal.open();  // nobody else writes this table
  remove_partial(output);
  return journal;
}

nlohmann::json head_of(const SweepOptions& options, const SweepGrid& grid, const std::string& variant,
                       const SweepBlocks& blocks, const Shard& shard) {
  return {{"scene", grid.base().name},
          {"implementation", variant},
          {"options", options.identity},
          {"file", checksum(grid.document().dump())},
          {"program", program_checksum()},
          {"columns", blocks.rows().head()},
          {"lanes", grid.lanes()},
          {"blocks", blocks.count()},
          {"shard", {shard.index + 1, shard.count}}};
}

void run_blocks(int jobs, const std::vector<long>& mine, const SweepBlocks& blocks, Journal& journal) {
  std::vector<long> open;
  for (const long block : mine) {
    if (!journal.has(block)) open.push_back(block);
  }
  Progress progress(static_cast<double>(mine.size()), "blocks of lanes");
  for_blocks(jobs, open, [&](long block) { return blocks.run(block); },
             [&](long block, const std::string& text) {
               journal.add(block, text);
               progress.at(static_cast<double>(journal.size()));
               return true;
             });
}

}  // namespace

int sweep(const SweepOptions& options) {
  const NamedVariant variant = select_variant(options.implementation);
  require_not_scene("--output", options.output, options.scene);
  const Shard shard = parse_shard(options.shard);
  const SweepGrid grid(options.scene, options.vary, options.sampling);
  resolve(options, grid.base());  // what is wrong with the options is not said of a lane
  const SweepBlocks blocks(options, grid, *variant.variant);
  const nlohmann::json head = head_of(options, grid, variant.name, blocks, shard);
  const bool is_part = !options.shard.empty();
  if (is_part && !is_file(options.output)) {
    throw UsageError("--output: found a device or a pipe, allowed with --shard is a file, for mbs merge-sweep");
  }
  std::error_code ignored;
  if (is_part && options.resume && fs::exists(options.output, ignored)) {
    const Journal done(options.output);
    require_same_sweep(done, head);
    return finish_part(done);
  }
  static_cast<void>(AtomicFile(options.output));  // says at once what cannot be written
  if (!options.resume) require_no_other(options.output + ".journal");
  std::vector<long> mine;
  for (long block = shard.index; block < blocks.count(); block += shard.count) mine.push_back(block);
  if (!fs::exists(options.output + ".journal", ignored)) {  // else it was done
    require_lanes(options.jobs, mine, blocks);
  }
  Journal journal = open_journal(options.output, head);
  run_blocks(options.jobs, mine, blocks, journal);
  if (is_part) {
    fs::rename(journal.path(), options.output);
    return finish_part(journal);
  }
  TableFile table(options.output);
  const int status = write_table({&journal}, table);
  fs::remove(journal.path(), ignored);
  return status;
}

}  // namespace mbs
