// Sums and sentences.
#include "mbs/sweep_outcomes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <vector>

namespace mbs {

void Outcomes::add(const Outcomes& other) {
  for (const auto& [status, lanes] : other.simulated) simulated[status] += lanes;
  not_assembled += other.not_assembled;
  alone |= other.alone;
}

long Outcomes::failed() const {
  long count = not_assembled;
  for (const auto& [status, lanes] : simulated) {
    if (!is_finished(status)) count += lanes;
  }
  return count;
}

std::string Outcomes::text() const {
  std::vector<std::string> parts;
  for (const auto& [status, lanes] : simulated) {
    parts.push_back(fmt::format("{} {}", lanes, to_string(status)));
  }
  if (not_assembled > 0) parts.push_back(fmt::format("{} {}", not_assembled, kNotAssembled));
  return fmt::format("{}", fmt::join(parts, ", "));
}

nlohmann::json Outcomes::to_json() const {
  nlohmann::json counts = nlohmann::json::array();
  for (const auto& [status, lanes] : simulated) counts.push_back({static_cast<int>(status), lanes});
  return {{"simulated", counts}, {"not_assembled", not_assembled}, {"alone", alone}};
}

Outcomes Outcomes::from_json(const nlohmann::json& json) {
  Outcomes outcomes;
  for (const auto& count : json.at("simulated")) {
    outcomes.simulated[static_cast<RunStatus>(count.at(0).get<int>())] = count.at(1);
  }
  outcomes.not_assembled = json.at("not_assembled");
  outcomes.alone = json.at("alone");
  return outcomes;
}

int report(const nlohmann::json& head, long lanes, const Outcomes& outcomes) {
  const std::string variant = head.at("implementation"), scene = head.at("scene");
  const std::string all = fmt::format("{} lane{}", lanes, lanes == 1 ? "" : "s");
  if (outcomes.alone) {
    fmt::print(stderr,
               "mbs: note: lanes ran one after the other: {} takes this scene with these settings "
               "only so\n",
               variant);
  }
  if (outcomes.failed() == 0) {
    fmt::print("{}: {}\n", all, outcomes.text());
    return 0;
  }
  fmt::print(stderr, "mbs: {} on {}: {} of {} failed: {} (column status_reason says why)\n", variant,
             scene, outcomes.failed(), all, outcomes.text());
  return 1;
}

}  // namespace mbs
