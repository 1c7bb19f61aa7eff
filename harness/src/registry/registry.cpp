// Looking variants up by the names that users type.
#include "registry/registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "limit/limit.hpp"
#include "registry/factory.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

bool is_limit(const std::string& name) { return name == "limit" || name == limit::kName; }

std::vector<NamedVariant> variants_where(bool tried) {
  std::vector<NamedVariant> result;
  for (const RegistryEntry& entry : registry()) {
    for (const Variant& variant : entry.implementation.variants) {
      if (variant.tried_for.empty() == tried) continue;
      result.push_back({entry.folder + "/" + variant.name, &entry, &variant});
    }
  }
  return result;
}

}  // namespace

std::vector<NamedVariant> all_variants() { return variants_where(false); }

std::vector<NamedVariant> tried_variants() { return variants_where(true); }

std::vector<NamedVariant> select_variants(const std::vector<std::string>& names) {
  std::vector<NamedVariant> all = all_variants();
  if (names.empty()) return all;
  for (const NamedVariant& one : tried_variants()) {
    if (std::ranges::find(names, one.name) != names.end()) all.push_back(one);
  }
  std::vector<NamedVariant> result;
  for (const std::string& name : names) {
    if (is_limit(name)) continue;
    for (const RegistryEntry& entry : registry()) {
      if (entry.folder == name.substr(0, name.find('/')) && !entry.unavailable.empty()) {
        throw UsageError(
            fmt::format("implementation '{}' is unavailable: {}", name, entry.unavailable));
      }
      for (const auto& [variant, reason] : entry.lacking) {
        if (entry.folder + "/" + variant != name) continue;
        throw UsageError(fmt::format("implementation '{}' is unavailable: {}", name, reason));
      }
    }
    const auto selected = [&name](const NamedVariant& variant) {
      return variant.name == name || variant.entry->folder == name;
    };
    if (std::ranges::none_of(all, selected)) {
      std::vector<std::string> known;
      for (const NamedVariant& variant : all_variants()) known.push_back(variant.name);
      throw UsageError(
          fmt::format("unknown implementation '{}': there are {}", name, fmt::join(known, ", ")));
    }
  }
  for (const NamedVariant& variant : all) {
    const auto wanted = [&variant](const std::string& name) {
      return variant.name == name || variant.entry->folder == name;
    };
    if (std::ranges::any_of(names, wanted)) result.push_back(variant);
  }
  if (std::ranges::any_of(names, is_limit)) {
    result.push_back({limit::kName, nullptr, &limit::variant()});
  }
  return result;
}

std::string why_not_offered(const std::string& variant, const Model& model,
                            const StepSettings& settings) {
  const auto variants = all_variants();
  const auto found = std::ranges::find(variants, variant, &NamedVariant::name);
  if (found == variants.end()) return "it is not in this build";
  const Variant& one = *found->variant;
  const std::string missing = why_not_served(one.serves, model, settings);
  if (!missing.empty()) return "it does not serve " + missing;
  return one.refuses == nullptr ? "" : one.refuses(model);
}

}  // namespace mbs
