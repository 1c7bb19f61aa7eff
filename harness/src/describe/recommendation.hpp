// Which implementation to take for a scene, by a measured rule.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "describe/rule.hpp"
#include "mbs/simulation.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// Why this build cannot run a variant on the scene with a scheme; empty if it can.
using WhyNot = std::function<std::string(const std::string& variant, Scheme scheme)>;

/// What `rule` says of a scene with this describe_json(). Keys:
///
/// - recommendation [{layer "library" or "own", implementation, scheme, step_us, low_us, high_us}],
///   the library layer first: the rule's choice of its candidates, then all by time; the own layer
///   by time. Only variants that were measured with the scheme and that `why_not` allows;
/// - no_recommendation: the reason why that is empty, or null;
/// - nearest {scene, distance, fastest, step_us}: the measured scene that is nearest in
///   kDistanceFeatures, the distance the root of the sum of their squared log ratios; or null;
/// - rule {set, machine, commit, held, candidates [{implementation, step_us, refused}], the time or
///   refused null, outside [features outside of those of all measured scenes]}, or null.
nlohmann::json recommendation_json(const std::optional<Rule>& rule,
                                   const nlohmann::json& description, const WhyNot& why_not);

/// A describe_json() of `scene` with recommendation_json() by the rule of this build. With `counts`
/// its passes are counted first, by the fastest of those that are recommended (count_passes()).
nlohmann::json recommended(nlohmann::json description, const Scene& scene, StepSettings settings,
                           bool counts);

/// The same for people, from the JSON of both: at most five lines.
std::string recommendation_text(const nlohmann::json& description);

}  // namespace mbs
