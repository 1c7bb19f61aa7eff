// What the agreement gate says of one implementation on one scene.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace mbs {

/// One comparison: passed if `value` <= `tolerance` (for an order: within it of 2).
struct Check {
  std::string name;             ///< "lock-step", "free-running", "passes", "exact", ...
  std::optional<double> value;  ///< measured; none if not run, or not a number
  std::optional<double> tolerance;
  std::optional<bool> passed;  ///< none if not run, or `value` judges nothing; see `detail`
  std::string detail;          ///< one line: where, which quantity, what unit
};

/// "agrees", "disagrees", "unsupported", "crashed", "timeout" or "out-of-memory".
struct Verdict {
  std::string scene;
  std::string implementation;
  std::string verdict;
  std::string reason;  ///< one line, empty if it agrees
  std::vector<Check> checks;

  [[nodiscard]] bool agrees() const { return verdict == "agrees"; }
};

void to_json(nlohmann::json& json, const Check& check);
void from_json(const nlohmann::json& json, Check& check);
void to_json(nlohmann::json& json, const Verdict& verdict);
void from_json(const nlohmann::json& json, Verdict& verdict);

}  // namespace mbs
