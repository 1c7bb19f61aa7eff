// Numbers of a scene that the time of a step is estimated from.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mbs {

/// Whether `feature` is one of README.md, "Features".
bool is_feature(const std::string& feature);

/// For people: "non-zeros a column of L".
std::string feature_text(const std::string& feature);

/// Every feature by name, from the other keys of describe_json(); null where the elimination was
/// not computed.
nlohmann::json features_json(const nlohmann::json& description);

}  // namespace mbs
