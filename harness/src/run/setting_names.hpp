// The choices among StepSettings by name, which of them go together, and who serves them.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "registry/registry.hpp"

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

/// Throws UsageError unless `settings` go together: paper/other_schemes.md, "Which settings go
/// together".
void require_combination(const StepSettings& settings);

/// The settings that differ from "The step" of the paper, as on a command line: "--scheme rattle
/// --projections-every 2"; empty if none does.
std::string other_settings(const StepSettings& settings);

/// Every setting under the name of its option, with _ for -.
nlohmann::json settings_json(const StepSettings& settings);

/// Which setting a variant that serves `serves` does not offer, for people; empty if none.
std::string why_not_served(const Serves& serves, const StepSettings& settings);

/// Why no implementation can simulate `model` with `settings`; empty if nothing forbids it.
std::string why_unsuited(const Model& model, const StepSettings& settings);

/// variant.create(), or Unsupported with why_unsuited() or why_not_served().
std::unique_ptr<Simulation> create_simulation(const Variant& variant, const Model& model,
                                              const StepSettings& settings);

/// The settings beyond the defaults that a variant serves, for people; empty if none.
std::vector<std::string> served_settings(const Serves& serves);

}  // namespace mbs
