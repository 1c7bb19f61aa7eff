// What `mbs simulate` says about a run.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "run/run.hpp"

namespace mbs {

/// The summary for programs.
nlohmann::json summary_json(const Scene& scene, const NamedVariant& variant,
                            const RunSettings& settings, const RunSummary& summary);

/// The same for people, several lines; `summary` tells a figure that is lost from one that there is
/// none of, which are both null in `json`.
std::string summary_text(const nlohmann::json& json, const RunSummary& summary);

}  // namespace mbs
