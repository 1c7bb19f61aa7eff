// The times and the nearest scene of a rule, asked about one scene.
#include "describe/recommendation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "describe/features.hpp"
#include "describe/passes.hpp"
#include "registry/registry.hpp"
#include "registry/setting_names.hpp"

namespace mbs {
namespace {

using nlohmann::json;

double step_us(const StepTime& time, const Features& scene) {
  double sum = 0.0;
  for (const TimeTerm& term : time.terms) {
    double us = term.us;
    for (const std::string& name : term.features) us *= scene.at(name);
    sum += us;
  }
  return sum;
}

/// Why `variant` is not among those to choose from; empty if it is.
std::string refusal(const TimedVariant& variant, Scheme scheme, const Features& scene,
                    const WhyNot& why_not) {
  if (!variant.times.contains(scheme)) {
    return fmt::format("its {} form was not measured", name_of(scheme));
  }
  if (!std::isfinite(step_us(variant.times.at(scheme), scene))) {
    return "its factorization is too much work to be counted";
  }
  return why_not(variant.name, scheme);
}

bool is_candidate(const Rule& rule, Scheme scheme, const std::string& variant) {
  const auto found = rule.candidates.find(scheme);
  return found != rule.candidates.end() &&
         std::ranges::find(found->second, variant) != found->second.end();
}

/// Features that are less than in every measured scene that has them, or more.
json outside(const std::vector<MeasuredScene>& scenes, const Features& scene) {
  json result = json::array();
  for (const auto& [name, value] : scene) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const MeasuredScene& other : scenes) {
      const auto found = other.features.find(name);
      if (found == other.features.end()) continue;
      least = std::min(least, found->second);
      most = std::max(most, found->second);
    }
    if (least <= most && (value < least || value > most)) result.push_back(name);
  }
  return result;
}

/// By layer; the candidate of the least time first, then by time.
json ranked(const Rule& rule, Scheme scheme, const Features& scene, const WhyNot& why_not) {
  // What is extrapolated is off by more: a range is then of its factors squared.
  const double power = outside(rule.scenes, scene).empty() ? 1.0 : 2.0;
  std::vector<json> result;
  std::string taken;
  double least = std::numeric_limits<double>::infinity();
  for (const TimedVariant& variant : rule.variants) {
    if (!refusal(variant, scheme, scene, why_not).empty()) continue;
    const StepTime& time = variant.times.at(scheme);
    const double us = step_us(time, scene);
    result.push_back({{"layer", variant.own ? "own" : "library"},
                      {"implementation", variant.name},
                      {"scheme", name_of(scheme)},
                      {"step_us", us},
                      {"low_us", us * std::pow(time.low, power)},
                      {"high_us", us * std::pow(time.high, power)}});
    if (is_candidate(rule, scheme, variant.name) && us < least) {
      taken = variant.name;
      least = us;
    }
  }
  const auto layer_and_time = [](const json& one) {
    return std::tuple(one["layer"] == "own", one["step_us"].get<double>());
  };
  std::ranges::stable_sort(result, {}, layer_and_time);
  const auto first =
      std::ranges::find_if(result, [&](const json& one) { return one["implementation"] == taken; });
  if (first != result.end()) std::rotate(result.begin(), first, first + 1);
  return result;
}

json nearest(const std::vector<MeasuredScene>& scenes, const Features& scene) {
  const auto distance = [&scene](const MeasuredScene& other) {
    double sum = 0.0;
    for (const char* name : kDistanceFeatures) {
      sum += std::pow(std::log(scene.at(name) / other.features.at(name)), 2);
    }
    return std::sqrt(sum);
  };
  const MeasuredScene& found = *std::ranges::min_element(scenes, {}, distance);
  return {{"scene", found.name},
          {"distance", distance(found)},
          {"fastest", found.fastest},
          {"step_us", found.step_us}};
}

/// What is compared: {implementation, step_us, refused}; the time null where refused.
json candidates(const Rule& rule, Scheme scheme, const Features& scene, const WhyNot& why_not) {
  json result = json::array();
  for (const TimedVariant& variant : rule.variants) {
    if (!is_candidate(rule, scheme, variant.name)) continue;
    const std::string refused = refusal(variant, scheme, scene, why_not);
    result.push_back(
        {{"implementation", variant.name}, {"step_us", nullptr}, {"refused", nullptr}});
    if (refused.empty()) {
      result.back()["step_us"] = step_us(variant.times.at(scheme), scene);
    } else {
      result.back()["refused"] = refused;
    }
  }
  return result;
}

json nothing(const std::string& reason) {
  return {{"recommendation", json::array()},
          {"no_recommendation", reason},
          {"nearest", nullptr},
          {"rule", nullptr}};
}

json held_json(const HeldOut& held) {
  return {{"families", held.families},     {"scenes", held.scenes}, {"mean_loss", held.mean_loss},
          {"worst_loss", held.worst_loss}, {"within", held.within}, {"inside", held.inside}};
}

}  // namespace

json recommendation_json(const std::optional<Rule>& rule, const json& description,
                         const WhyNot& why_not) {
  if (!rule) return nothing("no rule has been measured for this build");
  if (description["precision"] != name_of(Precision::double_precision)) {
    return nothing("steps were measured in double precision only");
  }
  if (description["elimination"]["flops"].is_null()) {
    return nothing("the elimination was not computed, it is too much work");
  }
  Features scene;  // infinite: too many to be counted
  for (const auto& [name, value] : description["features"].items()) {
    scene[name] = value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
  }
  const bool is_penalty = description["scheme"]["take"] == name_of(Scheme::penalty);
  const Scheme scheme = is_penalty ? Scheme::penalty : Scheme::saddle_point;
  const json list = ranked(*rule, scheme, scene, why_not);
  json result = {{"recommendation", list},
                 {"no_recommendation", nullptr},
                 {"nearest", nearest(rule->scenes, scene)},
                 {"rule",
                  {{"set", rule->set},
                   {"machine", rule->machine},
                   {"commit", rule->commit},
                   {"held", held_json(rule->held)},
                   {"candidates", candidates(*rule, scheme, scene, why_not)},
                   {"outside", outside(rule->scenes, scene)}}}};
  if (list.empty()) {
    result["no_recommendation"] = "nothing that was measured can run this";
  }
  return result;
}

json recommended(json description, const Scene& scene, StepSettings settings, bool counts) {
  const std::optional<Rule> rule = parse_rule(kRuleText);
  const auto of = [&settings](Scheme scheme) {
    settings.scheme = scheme;
    return settings;
  };
  const auto why_not = [&](const std::string& variant, Scheme scheme) {
    return why_not_offered(variant, scene.model, of(scheme));
  };
  json found = recommendation_json(rule, description, why_not);
  if (counts && !found["recommendation"].empty()) {
    const json& list = found["recommendation"];
    const std::string fastest = std::ranges::min_element(list, [](const json& a, const json& b) {
                                  return a["step_us"] < b["step_us"];
                                })->at("implementation");
    const NamedVariant by = select_variants({fastest}).front();
    for (const Scheme scheme : {Scheme::penalty, Scheme::saddle_point}) {
      if (!why_not(fastest, scheme).empty()) continue;
      const json& order = description["elimination"]["orderings"]
                                     [scheme == Scheme::penalty ? "AMD" : "saddle-point"];
      if (order.is_null()) continue;
      const auto passes = count_passes(scene, of(scheme), *by.variant, order["flops"],
                                       description["smallest_eigenvalue"]);
      if (!passes) continue;
      description["passes"][name_of(scheme)] = *passes;
      json& assumed = description["passes"]["assumed"];
      assumed.erase(std::find(assumed.begin(), assumed.end(), json(name_of(scheme))));
    }
    description["features"] = features_json(description);
    found = recommendation_json(rule, description, why_not);
  }
  description.update(found);
  return description;
}

}  // namespace mbs
