// How many lanes of a sweep ended how.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "run/run.hpp"

namespace mbs {

/// The status of a lane whose start cannot be assembled.
inline constexpr const char* kNotAssembled = "not-assembled";

struct Outcomes {
  std::map<RunStatus, long> simulated;
  long not_assembled = 0;
  bool alone = false;  ///< whether lanes that fit together ran one after the other

  void add(const Outcomes& other);
  [[nodiscard]] long failed() const;
  [[nodiscard]] std::string text() const;  ///< "5 ok, 1 diverged"
  [[nodiscard]] nlohmann::json to_json() const;
  static Outcomes from_json(const nlohmann::json& json);
};

/// Says how the sweep `head` of a journal went; the exit status.
int report(const nlohmann::json& head, long lanes, const Outcomes& outcomes);

}  // namespace mbs
