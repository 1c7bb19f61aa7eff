// The implementations of this build, from the list in implementations/CMakeLists.txt.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mbs/implementation.hpp"

namespace mbs {

/// One folder of the list: available, or kept visible with the reason why not.
struct RegistryEntry {
  std::string folder;
  Implementation implementation;  ///< empty if unavailable
  std::string unavailable;        ///< the reason, empty if available
  /// Variants that this build lacks, with the reason.
  std::vector<std::pair<std::string, std::string>> lacking = {};
};

/// All entries in the order of the list. Defined by the generated registry.cpp, or by a test's own.
const std::vector<RegistryEntry>& registry();

/// One runnable variant and the name it goes by everywhere, "folder/variant".
struct NamedVariant {
  std::string name;
  const RegistryEntry* entry = nullptr;  ///< none for the limit code
  const Variant* variant = nullptr;
};

/// Whether the linear algebra of a variant is this repository's own, on no library.
inline bool is_own_code(const Implementation& implementation, const Variant& variant) {
  return implementation.library == "none" || variant.own_code;
}

/// Every available variant that stands for itself, in order.
std::vector<NamedVariant> all_variants();

/// Those that were tried for another one (Variant::tried_for), in order.
std::vector<NamedVariant> tried_variants();

/// The variants that `names` select, in order: "folder/variant", or "folder" for all of its
/// variants that stand for themselves; an empty list selects all of these. Throws UsageError with
/// the known names if one is unknown, or with the reason if it is unavailable. "limit" or
/// "limit/limit" adds the code of limit/, which an empty list never does.
std::vector<NamedVariant> select_variants(const std::vector<std::string>& names);

/// Why this build cannot run the variant of this name on `model` with `settings`; empty if it can.
std::string why_not_offered(const std::string& variant, const Model& model,
                            const StepSettings& settings);

inline RegistryEntry available(std::string folder, Implementation implementation,
                               std::vector<std::pair<std::string, std::string>> lacking = {}) {
  return {std::move(folder), std::move(implementation), "", std::move(lacking)};
}
inline RegistryEntry unavailable(std::string folder, std::string reason) {
  return {std::move(folder), {}, std::move(reason)};
}

}  // namespace mbs
