// Reads a rule and refuses one that does not fit.
#include "describe/rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "describe/features.hpp"
#include "registry/setting_names.hpp"

namespace mbs {
namespace {

using nlohmann::json;

void require(bool holds, const std::string& wanted) {
  if (!holds) throw std::runtime_error(wanted);
}

double read_number(const json& value, const char* what, double least) {
  const double found = value.at(what);
  require(std::isfinite(found) && found >= least,
          fmt::format("{} is {}, allowed are numbers from {}", what, found, least));
  return found;
}

std::string known_feature(const std::string& name) {
  require(is_feature(name), fmt::format("'{}' is no feature", name));
  return name;
}

Features read_features(const json& values) {
  Features result;
  for (const auto& [name, value] : values.items()) {
    result[known_feature(name)] = read_number(values, name.c_str(), 0.0);
  }
  return result;
}

/// From a name such as "n*n*m", "passes*1" or "1".
TimeTerm read_term(const json& values, const std::string& name) {
  TimeTerm result{{}, read_number(values, name.c_str(), 0.0)};
  std::istringstream words(name);
  for (std::string word; std::getline(words, word, '*');) {
    if (word != "1") result.features.push_back(known_feature(word));
  }
  return result;
}

TimedVariant read_variant(const std::string& name, const json& value) {
  const std::string layer = value.at("layer");
  require(layer == "library" || layer == "own",
          fmt::format("{}: the layer is '{}', allowed are library and own", name, layer));
  TimedVariant result{name, layer == "own", {}};
  for (const Scheme scheme : {Scheme::penalty, Scheme::saddle_point}) {
    const auto found = value.find(name_of(scheme));
    if (found == value.end() || found->is_null()) continue;
    StepTime& time = result.times[scheme];
    time = {{}, read_number(*found, "low", 0.0), read_number(*found, "high", 0.0)};
    for (const auto& [term, us] : found->at("coefficients").items()) {
      time.terms.push_back(read_term(found->at("coefficients"), term));
    }
    require(time.low <= time.high, fmt::format("{}: low is above high", name));
  }
  require(!result.times.empty(), fmt::format("{} has no times", name));
  return result;
}

MeasuredScene read_scene(const json& value) {
  MeasuredScene result{value.at("scene"), read_features(value.at("features")), value.at("fastest"),
                       read_number(value, "step_us", 0.0)};
  for (const char* name : kDistanceFeatures) {
    require(result.features[name] > 0.0,
            fmt::format("scene {}: the feature {} is missing or 0", result.name, name));
  }
  return result;
}

void read_candidates(const json& value, Rule& rule) {
  std::size_t count = 0;
  for (const Scheme scheme : {Scheme::penalty, Scheme::saddle_point}) {
    const auto found = value.find(name_of(scheme));
    if (found == value.end()) continue;
    for (const std::string name : *found) {
      const auto variant = std::ranges::find(rule.variants, name, &TimedVariant::name);
      require(variant != rule.variants.end() && !variant->own && variant->times.contains(scheme),
              fmt::format("the candidate {} is no library with times in the {} form", name,
                          name_of(scheme)));
      rule.candidates[scheme].push_back(name);
      ++count;
    }
  }
  require(count > 0 && count <= kMostCandidates,
          fmt::format("there are {} candidates, allowed are 1 to {}", count, kMostCandidates));
}

Rule read_rule(const json& value) {
  Rule result{value.at("set"), value.at("machine"), value.at("commit"), {}, {}, {}, {}};
  const json& held = value.at("held");
  result.held = {held.at("families"),
                 held.at("scenes"),
                 read_number(held, "mean_loss", 0.0),
                 read_number(held, "worst_loss", 0.0),
                 read_number(held, "within", 0.0),
                 read_number(held, "inside", 0.0)};
  for (const auto& [name, times] : value.at("times").items()) {
    result.variants.push_back(read_variant(name, times));
  }
  for (const json& scene : value.at("scenes")) result.scenes.push_back(read_scene(scene));
  require(!result.scenes.empty(), "there are no scenes");
  read_candidates(value.at("candidates"), result);
  return result;
}

}  // namespace

std::optional<Rule> parse_rule(const std::string& text) {
  try {
    const json value = json::parse(text);
    require(value.is_object(), "it is no object");
    if (value.empty()) return std::nullopt;
    return read_rule(value);
  } catch (const std::exception& error) {  // of JSON's too: a missing key, a wrong type
    throw std::runtime_error(fmt::format("the rule of mbs describe: {}", error.what()));
  }
}

}  // namespace mbs
