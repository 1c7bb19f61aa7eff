// From a SceneDraft, placed and with bases chosen, to ModelData and Elements.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/mass_writer.hpp"
#include "scene/row_writer.hpp"
#include "scene/scene_draft.hpp"

namespace mbs {

/// A scene that has its equations.
struct Lowered {
  SceneData data;
  std::vector<std::string> labels;  ///< of the points of the model, for messages
  /// Springs whose free length or angle is that of the assembled start.
  std::vector<std::size_t> relaxed_springs, relaxed_torsion_springs;
};

/// What the constraints are written with, shared by the parts of lowering.
class Lowering {
 public:
  explicit Lowering(SceneDraft& draft) : draft_(draft), rows_(lowered_.data.model) {}

  Lowered run();

 private:
  using Row = RowWriter::Row;
  using Edge = RowWriter::Edge;
  using Part = RowWriter::Part;
  /// What an output of the force of a rod or constraint needs.
  struct Force {
    Output::Force kind = Output::Force::multiplier;
    std::vector<Row> rows = {};
    DraftDirection first = {}, second = {};
    double factor = 1.0;
  };

  // lowering.cpp
  void number_points();
  void add_point(DraftPoint& point);
  [[nodiscard]] std::string velocity_path(const DraftPoint& point) const;
  void lower_rods();
  void lower_masses();
  void lower_elements();
  void lower_outputs();
  void refuse_same_columns() const;
  [[nodiscard]] int element_index(int point) const;
  [[nodiscard]] double default_correction() const;
  [[nodiscard]] ModelData& model() { return lowered_.data.model; }
  [[nodiscard]] int index(int point) const { return draft_.point(point).index; }
  [[nodiscard]] const Vector3& position(int point) const { return *draft_.point(point).position; }
  [[nodiscard]] Vector3 along(const DraftDirection& direction) const;
  [[nodiscard]] Edge edge(const DraftDirection& direction);
  /// Index of a fixed point at 0, for unit vectors as differences; made where none is there.
  int zero();
  /// A fixed point of the model's own; its index there.
  int add_hidden(const std::string& name, bool is_vector);
  void remember(const JsonNode& node, Force force);  // for outputs by name

  // lower_bodies.cpp
  friend class BodyLowering;
  void lower_bodies();

  // lower_constraints.cpp
  void lower_constraint(const DraftConstraint& constraint);
  [[nodiscard]] static Force force_of(const DraftConstraint& constraint, std::vector<Row> rows);
  void lower_distance(const DraftConstraint& constraint);
  void lower_angle(const DraftConstraint& constraint);
  void lower_fixed_angle(const DraftConstraint& constraint, const TimeFunction& angle);
  void lower_moving_angle(const DraftConstraint& constraint, const TimeFunction& angle);
  void lower_spatial_angle(const DraftConstraint& constraint, const TimeFunction& angle);
  void lower_perpendicular(const DraftConstraint& constraint);
  void lower_coincident(const DraftConstraint& constraint);
  void lower_on_line(const DraftConstraint& constraint);
  void lower_dot(const DraftConstraint& constraint);
  void lower_linear(const DraftConstraint& constraint);
  [[nodiscard]] double start_angle(const DraftConstraint& constraint) const;
  [[nodiscard]] std::optional<double> constant_length(const DraftDirection& direction) const;
  [[nodiscard]] double required_length(const DraftConstraint& constraint,
                                       const DraftDirection& direction, const char* key) const;
  int driven_normal(const DraftConstraint& constraint, const TimeFunction& angle, double sign,
                    double offset, double length);
  /// fixed . (the moving direction).
  [[nodiscard]] std::vector<Part> fixed_dot(const Vector3& fixed,
                                            const DraftDirection& moving) const;
  void refuse_same_dot(const JsonNode& node, const DraftDirection& first,
                       const DraftDirection& second);
  Row distinct_linear(const JsonNode& node, const std::string& name, const std::vector<Part>& parts,
                      const TimeFunction& value);

  // lower_forces.cpp (finish_start() too)
  void lower_forces();
  void lower_spring(const DraftSpring& spring);
  void lower_torsion_spring(const DraftTorsionSpring& spring);
  void lower_torque(const DraftTorque& torque);
  void lower_force_law(const DraftForceLaw& law);
  void lower_torque_law(const DraftTorqueLaw& law);

  SceneDraft& draft_;
  Lowered lowered_;
  RowWriter rows_;
  std::optional<MassWriter> mass_;
  int zero_ = -1;
  std::unordered_map<std::string, Force> forces_;   // of rods and constraints
  std::map<std::pair<int, int>, double> lengths_;   // constant ones, by indices into the model
  std::map<std::array<int, 4>, std::string> dots_;  // path of the first such constraint
  struct Known {
    std::string path;
    double value = 0.0;  // at t = 0
  };
  std::map<std::vector<std::pair<int, double>>, Known> linears_;  // by terms whose first has 1
};

/// Planar: u . B w is the cross product u x w.
inline constexpr Matrix3 kCrossProduct{{{0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}};

/// Lowers a draft whose bases are chosen and whose points are placed. Throws UsageError.
Lowered lower(SceneDraft& draft);

/// After the assembly: springs of no stated free length or angle get that of the start. Throws
/// UsageError, prefixed by `where`, if what an axis turns is not perpendicular to it.
void finish_start(Lowered& lowered, const std::string& where);

}  // namespace mbs
