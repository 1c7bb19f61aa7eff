// Which implementation suits which scene: what was measured, as rule.json has it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs {

/// Features by name.
using Features = std::map<std::string, double>;

/// A product of features, of none 1, and what it costs.
struct TimeTerm {
  std::vector<std::string> features;
  double us = 0.0;  ///< at least 0
};

/// Time of a step in us: the sum over terms of us times the features; factors give its range.
struct StepTime {
  std::vector<TimeTerm> terms;
  double low = 1.0, high = 1.0;
};

struct TimedVariant {
  std::string name;
  bool own = false;  ///< of the own code, not of libraries
  std::map<Scheme, StepTime> times;
};

/// How the choice did on families of scenes that it was not fitted to.
struct HeldOut {
  int families = 0, scenes = 0;
  double mean_loss = 0.0, worst_loss = 0.0;  ///< time over that of the fastest, less 1
  double within = 0.0;                       ///< share of step times within a factor of 1.5
  double inside = 0.0;                       ///< share of them inside their range
};

struct MeasuredScene {
  std::string name;
  Features features;
  std::string fastest;
  double step_us = 0.0;
};

struct Rule {
  std::string set, machine, commit;
  /// Variants of libraries with a time in that form, at most kMostCandidates in all: the one
  /// whose time is the least is taken.
  std::map<Scheme, std::vector<std::string>> candidates;
  HeldOut held;
  std::vector<TimedVariant> variants;
  std::vector<MeasuredScene> scenes;  ///< at least one
};

/// What a scene's distance to a measured one is taken in; every measured scene has them, above 0.
inline constexpr const char* kDistanceFeatures[] = {"n", "per_column", "flops", "tangent"};

inline constexpr int kMostCandidates = 6;

/// None from an empty object, {}: no rule has been measured. Throws std::runtime_error, with the
/// reason on one line, if `text` is no rule; README.md has the format.
std::optional<Rule> parse_rule(const std::string& text);

/// rule.json of this build.
extern const char* const kRuleText;

}  // namespace mbs
