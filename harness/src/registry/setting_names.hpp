// The choices among StepSettings by name, and which of them go together.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs {

/// All values of Scheme, Projections, MultiplierUpdate, TangentReuse or Precision, with the names
/// that command lines and results have for them; the default first.
template <class Choice>
const std::vector<std::pair<std::string, Choice>>& choices();

template <class Choice>
std::vector<std::string> choice_names() {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices<Choice>()) names.push_back(name);
  return names;
}

template <class Choice>
std::string name_of(Choice choice) {
  for (const auto& [name, value] : choices<Choice>()) {
    if (value == choice) return name;
  }
  return "unknown";
}

/// RATTLE or what starts with it: no trapezoidal rule.
bool is_explicit(Scheme scheme);

/// Throws UsageError unless `settings` go together: paper/other_schemes.md, "Which settings go
/// together".
void require_combination(const StepSettings& settings);

/// Throws UsageError unless `step` (s) is a sensible time step.
void require_step(double step);

/// The settings that differ from "The step" of the paper, as on a command line: "--scheme rattle
/// --projections-every 2"; empty if none does.
std::string other_settings(const StepSettings& settings);

/// Every setting under the name of its option, with _ for -.
nlohmann::json settings_json(const StepSettings& settings);

}  // namespace mbs
