// Families of mechanisms: names such as "ladder:12", each with a function that writes the scene.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mbs {

/// A whole number that a name states: a size, "3" and "4" in "grid:3x4", or an option, "nodes=8".
struct FamilyParameter {
  const char* name;    ///< "N", "nodes"
  const char* symbol;  ///< of its value, for people: "N", "K"
  int least = 1, most = 1;
  std::optional<int> otherwise = {};  ///< of an option left out; a size has none
};

/// What a scene of a family has; README.md in this folder has the formulas.
struct SceneSize {
  long variables = 0;    ///< n
  long constraints = 0;  ///< m
};

/// In the order of SceneFamily::parameters.
using FamilyValues = std::vector<int>;

struct SceneFamily {
  const char* name;                         ///< "grid"
  const char* title;                        ///< what machine it stands for
  std::vector<FamilyParameter> parameters;  ///< sizes first
  SceneSize (*size)(const FamilyValues& values);
  /// A scene as a user would write it (harness/scenes/README.md), consistent at its start.
  nlohmann::json (*document)(const FamilyValues& values);

  /// How it is typed: "grid:NxM", "chain:N[,dimension=D]".
  [[nodiscard]] std::string form() const;
  /// "N from 4 to 20001; nodes from 3 to 200, 8 if left out".
  [[nodiscard]] std::string ranges() const;
};

inline constexpr long kMostFamilyVariables = 40'000;  ///< n, whatever the parameters

/// In the order of README.md in this folder.
std::span<const SceneFamily> scene_families();

/// Whether `text` begins with the name of a family and a colon.
bool is_family_scene(std::string_view text);

/// The document of "NAME:SIZES,OPTIONS". Throws UsageError, which says what is allowed.
nlohmann::json family_document(const std::string& text);

/// A whole number from `least` to `most` without sign or leading 0. Throws UsageError, which names
/// `scene` and `parameter`.
int parse_whole(const std::string& scene, std::string_view text, const char* parameter, int least,
                int most);

}  // namespace mbs
