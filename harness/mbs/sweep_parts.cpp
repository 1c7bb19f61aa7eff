// Block b is in part b modulo their number.
#include "mbs/sweep_parts.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "atomic_file.hpp"
#include "mbs/file_names.hpp"
#include "mbs/sweep_outcomes.hpp"
#include "mbs/table_file.hpp"
#include "printable.hpp"
#include "sweep/value_range.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

namespace fs = std::filesystem;

std::string shown(const std::string& path) { return printable(path, kLongestPath); }

/// Takes the line of outcomes off.
Outcomes take_outcomes(std::string& text) {
  const auto end = text.find('\n');
  const Outcomes outcomes = Outcomes::from_json(nlohmann::json::parse(text.substr(0, end)));
  text.erase(0, end + 1);
  return outcomes;
}

nlohmann::json without_shard(nlohmann::json head) {
  head.erase("shard");
  return head;
}

/// Which of how many parts it is, from 1.
std::pair<long, long> shard_of(const Journal& part) {
  const auto& shard = part.head().at("shard");
  const long number = shard.at(0), count = shard.at(1);
  if (number >= 1 && number <= count && count <= kMostLanes) return {number, count};
  throw UsageError(fmt::format("{}: found part {} of {}, allowed is i of K with i from 1 to K",
                               shown(part.path()), number, count));
}

/// The first that it should have and does not.
std::optional<long> missing_block(const Journal& part) {
  const auto [number, step] = shard_of(part);
  const long count = part.head().at("blocks");
  for (long block = number - 1; block < count; block += step) {
    if (!part.has(block)) return block;
  }
  return std::nullopt;
}

void require_all_blocks(const Journal& part) {
  const auto block = missing_block(part);
  if (!block) return;
  throw UsageError(fmt::format(
      "{}: {} (block {} of {} is missing), its command with --resume {} it", shown(part.path()),
      part.damage() ? "this part is damaged or was changed" : "this part is not finished", *block,
      part.head().at("blocks").get<long>(), part.damage() ? "mends" : "finishes"));
}

/// What was left beside `path` by a process that was killed while it wrote the table.
void remove_partial(const std::string& path) {
  std::error_code ignored;
  const fs::path table = fs::weakly_canonical(fs::absolute(path), ignored);
  const std::string begin = partial_begin(table.filename().string()), end = ".partial";
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(table.parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= begin.size() + end.size() || !name.starts_with(begin) || !name.ends_with(end)) continue;
    const std::string between = name.substr(begin.size(), name.size() - begin.size() - end.size());
    if (between.find_first_not_of("0123456789-") == std::string::npos) left.push_back(entry.path());
  }
  for (const fs::path& file : left) fs::remove(file, ignored);
}

}  // namespace

void require_same_sweep(const Journal& journal, const nlohmann::json& head) {
  for (const auto& [key, value] : head.items()) {
    const auto found = journal.head().find(key);
    if (found != journal.head().end() && *found == value) continue;
    const std::string what = key == "program"     ? "another build of mbs"
                             : key == "libraries" ? "other libraries"
                             : key == "processor" ? "another processor"
                                                  : fmt::format("another sweep (not the same: {})", key);
    throw UsageError(fmt::format("{}: found {}, allowed is the same", shown(journal.path()), what));
  }
}

int write_table(const std::vector<const Journal*>& parts, const std::string& output) {
  remove_partial(output);
  TableFile table(output);
  const nlohmann::json& head = parts.front()->head();
  table.write(head.at("columns"));
  Outcomes all;
  const auto count = head.at("blocks").get<std::size_t>();
  for (std::size_t block = 0; block < count; ++block) {
    std::string text = parts[block % parts.size()]->read(static_cast<long>(block));
    all.add(take_outcomes(text));
    table.write(text);
  }
  table.commit();
  return report(head, head.at("lanes"), all);
}

bool has_all_blocks(const Journal& part) { return !missing_block(part); }

int finish_part(const Journal& part) {
  require_all_blocks(part);
  const auto [number, step] = shard_of(part);
  const long count = part.head().at("blocks");
  Outcomes all;
  for (long block = number - 1; block < count; block += step) {
    std::string text = part.read(block);
    all.add(take_outcomes(text));
  }
  long lanes = all.not_assembled;
  for (const auto& [status, number] : all.simulated) lanes += number;
  return report(part.head(), lanes, all);
}

int merge_sweep(const std::vector<std::string>& paths, const std::string& output) {
  std::vector<Journal> journals;
  journals.reserve(paths.size());
  for (const std::string& path : paths) {
    if (is_same_file(path, output)) throw UsageError("--output: found a part, allowed is another file");
    journals.emplace_back(path);
  }
  const long count = shard_of(journals.front()).second;
  std::vector<const Journal*> parts(static_cast<std::size_t>(count));
  for (const Journal& journal : journals) {
    require_same_sweep(journal, without_shard(journals.front().head()));
    const auto [number, of] = shard_of(journal);
    if (of != count) {
      throw UsageError(fmt::format("{}: it is one of {} parts, the first of {}", shown(journal.path()), of, count));
    }
    const Journal*& place = parts[static_cast<std::size_t>(number - 1)];
    if (place != nullptr) {
      throw UsageError(fmt::format("{}: part {} of {} is given twice (it is {} too)",
                                   shown(journal.path()), number, count, shown(place->path())));
    }
    place = &journal;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i] == nullptr) {
      throw UsageError(fmt::format("part {} of {} is missing", i + 1, count));
    }
    require_all_blocks(*parts[i]);
  }
  return write_table(parts, output);
}

}  // namespace mbs
