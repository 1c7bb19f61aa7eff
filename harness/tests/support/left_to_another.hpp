// Variants that are for some scenes alone.
#pragma once

#include <algorithm>

#include "check/verdict.hpp"
#include "registry/factory.hpp"

namespace mbs::test {

/// Whether the variant refused the model, and another one of its folder takes it.
inline bool is_left_to_another(const Verdict& verdict, const NamedVariant& variant,
                               const Model& model, const StepSettings& settings) {
  const auto takes = [&](const Variant& other) {
    try {
      return create_simulation(other, model, settings) != nullptr;
    } catch (const Unsupported&) {
      return false;
    }
  };
  return verdict.verdict == "unsupported" &&
         std::ranges::any_of(variant.entry->implementation.variants, takes);
}

}  // namespace mbs::test
