// From the members of a JSON scene to a SceneDraft.
#pragma once

#include <array>
#include <initializer_list>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/json_node.hpp"
#include "scene/scene_draft.hpp"

namespace mbs {

/// Reads one scene, checking each member for itself and against what it refers to; whether the
/// whole makes sense is for choose_bases(), place(), lower() and check_scene(). Throws UsageError.
class SceneReader {
 public:
  /// The value of `root` must outlive the draft.
  explicit SceneReader(JsonNode root) : root_(std::move(root)) {}

  SceneDraft read();

 private:
  [[nodiscard]] std::vector<JsonNode> list(std::string_view key) const;
  [[nodiscard]] bool is_spatial() const { return draft_.dimension == 3; }

  // scene_reader.cpp
  void read_dimension_and_gravity();
  void read_point(const JsonNode& node);
  void read_driven(const JsonNode& node, DraftPoint& point);
  void read_vector(const JsonNode& node);
  void read_rod(const JsonNode& node);
  void read_mass(const JsonNode& node);
  void read_assembly(const JsonNode& node);
  /// A function of time, listed as a driver unless it is constant.
  TimeFunction read_driver(const JsonNode& node, const std::string& unit,
                           const DraftConstraint* constraint = nullptr);

  // reader_bodies.cpp
  void read_body(const JsonNode& node);
  [[nodiscard]] Inertia read_inertia(const JsonNode& node) const;
  void read_items(const JsonNode& node, int body, bool are_vectors);
  void read_pose(const JsonNode& node, DraftBody& body) const;

  // reader_constraints.cpp
  void read_constraint(const JsonNode& node);
  void read_angle(const JsonNode& node, DraftConstraint& constraint);
  void read_coincident(const JsonNode& node, DraftConstraint& constraint);
  void read_on_line(const JsonNode& node, DraftConstraint& constraint);
  void read_line_in_space(const JsonNode& node, DraftConstraint& constraint);
  void read_dot(const JsonNode& node, DraftConstraint& constraint);
  void read_linear(const JsonNode& node, DraftConstraint& constraint);
  [[nodiscard]] DraftConstraint::Term read_term(const JsonNode& node);
  /// Of a body that has the point.
  [[nodiscard]] Vector3 local_of(int body, int point) const;
  /// A vector of the body across the local direction `along` (and `beside`): one that it has, or a
  /// new one.
  int vector_across(int body, const Vector3& along, const Vector3* beside = nullptr);

  // reader_forces.cpp
  void read_spring(const JsonNode& node);
  void read_torsion_spring(const JsonNode& node);
  void read_force(const JsonNode& node);
  void read_torque(const JsonNode& node);
  void read_torque_on_body(const JsonNode& node, DraftTorque& torque);
  /// The points of two directions, as use_between() has them.
  void use_directions(const JsonNode& node, const DraftDirection& from, const DraftDirection& to);

  // reader_laws.cpp
  void read_force_law(const JsonNode& node);
  void read_torque_law(const JsonNode& node);
  /// A law over `position` ("length" or "angle"), whose tables have a column of `values`.
  [[nodiscard]] Law read_law(const JsonNode& node, const std::string& position,
                             const std::string& values);
  /// The unit vector "axis", which must be there in space and must not in the plane (-1).
  int axis(const JsonNode& node);

  // reader_outputs.cpp
  void read_output(const JsonNode& node);
  void read_asked(const JsonNode& node, const JsonNode& value, DraftOutput& asked);

  // reader_names.cpp
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

  JsonNode root_;
  SceneDraft draft_;
  std::unordered_map<std::string, int> body_of_;
  std::unordered_map<std::string, std::string> element_of_;  // name to path
  std::unordered_map<std::string, std::string> output_of_;   // the same
};

/// Whether a name can start the name of a CSV column: no comma, quotation mark, control character
/// or blank at its ends.
bool is_usable_name(std::string_view name);
inline constexpr const char* kUsableName =
    "a name without comma, quotation mark, control character or blank at its ends";

}  // namespace mbs
