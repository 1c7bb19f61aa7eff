// Block b is in part b modulo their number.
#include "mbs/sweep_parts.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "mbs/file_names.hpp"
#include "mbs/sweep_outcomes.hpp"
#include "printable.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

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

void require_all_blocks(const Journal& part) {
  const long first = part.head().at("shard").at(0).get<long>() - 1;
  const long step = part.head().at("shard").at(1), count = part.head().at("blocks");
  for (long block = first; block < count; block += step) {
    if (part.is_whole() && part.has(block)) continue;
    throw UsageError(fmt::format("{}: this part is not finished (block {} of {}), its command with "
                                 "--resume finishes it",
                                 shown(part.path()), block, count));
  }
}

}  // namespace

void require_same_sweep(const Journal& journal, const nlohmann::json& head) {
  for (const auto& [key, value] : head.items()) {
    const auto found = journal.head().find(key);
    if (found != journal.head().end() && *found == value) continue;
    const std::string what =
        key == "program" ? "another build of mbs" : fmt::format("another sweep (not the same: {})", key);
    throw UsageError(fmt::format("{}: found {}, allowed is the same", shown(journal.path()), what));
  }
}

int write_table(const std::vector<const Journal*>& parts, TableFile& table) {
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

int finish_part(const Journal& part) {
  require_all_blocks(part);
  const long first = part.head().at("shard").at(0).get<long>() - 1;
  const long step = part.head().at("shard").at(1), count = part.head().at("blocks");
  Outcomes all;
  for (long block = first; block < count; block += step) {
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
  const auto count = journals.front().head().at("shard").at(1).get<std::size_t>();
  std::vector<const Journal*> parts(count);
  for (const Journal& journal : journals) {
    require_same_sweep(journal, without_shard(journals.front().head()));
    const auto& shard = journal.head().at("shard");
    if (shard.at(1) != count) {
      throw UsageError(fmt::format("{}: it is one of {} parts, the first of {}", shown(journal.path()),
                                   shard.at(1).get<long>(), count));
    }
    const Journal*& place = parts[shard.at(0).get<std::size_t>() - 1];
    if (place != nullptr) {
      throw UsageError(fmt::format("{}: part {} of {} is given twice (it is {} too)",
                                   shown(journal.path()), shard.at(0).get<long>(), count,
                                   shown(place->path())));
    }
    place = &journal;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (parts[i] == nullptr) {
      throw UsageError(fmt::format("part {} of {} is missing", i + 1, count));
    }
    require_all_blocks(*parts[i]);
  }
  TableFile table(output);
  return write_table(parts, table);
}

}  // namespace mbs
