// From the members of a JSON scene to a SceneDraft: what all kinds are read with.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene_file/json_node.hpp"
#include "scene_file/scene_draft.hpp"

namespace mbs {

/// Reads one scene, checking each member for itself and against what it refers to; whether the
/// whole makes sense is for choose_bases(), place(), lower() and check_scene(). Everything throws
/// UsageError.
class SceneReader {
 public:
  /// The value of `root` must outlive the draft.
  explicit SceneReader(JsonNode root) : root_(std::move(root)) {}

  SceneDraft read();

  // What follows is for the kinds.
  [[nodiscard]] SceneDraft& draft() { return draft_; }
  [[nodiscard]] bool is_spatial() const { return draft_.dimension == 3; }

  /// A new point or unit vector; its index.
  int add_name(const JsonNode& node, const std::string& name, bool is_vector);
  [[nodiscard]] int named(const JsonNode& node) const;   ///< a point or unit vector
  [[nodiscard]] int point(const JsonNode& node) const;   ///< a point
  [[nodiscard]] int vector(const JsonNode& node) const;  ///< a unit vector
  [[nodiscard]] int body(const JsonNode& node) const;
  [[nodiscard]] std::pair<int, int> point_pair(const JsonNode& node) const;
  [[nodiscard]] DraftDirection direction(const JsonNode& node) const;
  [[nodiscard]] Vector3 coordinates(const JsonNode& node) const;
  [[nodiscard]] Vector3 unit_vector(const JsonNode& node) const;
  /// "rods[0]", or with its own name, which no other rod, body or constraint may have.
  std::string element_name(const JsonNode& node);
  void use(int point) { draft_.point(point).is_used = true; }
  void use(const DraftDirection& direction) {
    if (direction.from >= 0) use(direction.from);
    use(direction.to);
  }
  /// The points of a constraint or rod: all of them get coordinates; refused if none is free, or if
  /// one body has them all.
  void use_between(const JsonNode& node, const std::vector<int>& points);
  void use_between(const JsonNode& node, const DraftDirection& first, const DraftDirection& second);
  /// The unit vector "axis", which must be there in space and must not in the plane (-1).
  int axis(const JsonNode& node);
  /// In a body that has the point.
  [[nodiscard]] Vector3 local_of(int body, int point) const;
  /// A vector of the body across the local direction `along` (and `beside`): one that it has, or a
  /// new one.
  int vector_across(int body, const Vector3& along, const Vector3* beside = nullptr);

 private:
  [[nodiscard]] std::vector<JsonNode> list(std::string_view key) const;
  void read_dimension_and_gravity();
  void read_assembly(const JsonNode& node);

  JsonNode root_;
  SceneDraft draft_;
  std::unordered_map<std::string, std::string> element_of_;  // name to path
};

/// Whether a name can start the name of a CSV column: no comma, quotation mark, control character
/// or blank at its ends, and nothing at its beginning that a spreadsheet takes for a formula.
bool is_usable_name(std::string_view name);
inline constexpr const char* kUsableName =
    "a name without comma, quotation mark, control character or blank at its ends, and without "
    "=, +, - or @ at its beginning";

}  // namespace mbs
