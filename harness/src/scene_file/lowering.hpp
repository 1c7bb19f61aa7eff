// From a SceneDraft, placed and with bases chosen, to ModelData and Elements: what all kinds are
// lowered with.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/mass_writer.hpp"
#include "scene_file/row_writer.hpp"
#include "scene_file/scene_draft.hpp"

namespace mbs {

/// A scene that has its equations.
struct Lowered {
  SceneData data;
  std::vector<std::string> labels;  ///< of the points of the model, for messages
  /// Springs whose free length or angle is that of the assembled start.
  std::vector<std::size_t> relaxed_springs, relaxed_force_laws, relaxed_torsion_springs;
};

class Lowering {
 public:
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

  explicit Lowering(SceneDraft& draft) : draft_(draft), rows_(lowered_.data.model) {}

  Lowered run();

  // What follows is for the kinds. `int` refers to a draft point unless it says otherwise.
  [[nodiscard]] SceneDraft& draft() { return draft_; }
  [[nodiscard]] Lowered& lowered() { return lowered_; }
  [[nodiscard]] ModelData& model() { return lowered_.data.model; }
  [[nodiscard]] Elements& elements() { return lowered_.data.elements; }
  [[nodiscard]] RowWriter& rows() { return rows_; }
  [[nodiscard]] MassWriter& mass() { return *mass_; }

  /// Into Model::points().
  [[nodiscard]] int index(int point) const { return draft_.point(point).index; }
  /// The same, or of a marker past its end.
  [[nodiscard]] int element_index(int point) const;
  [[nodiscard]] const Vector3& position(int point) const { return *draft_.point(point).position; }
  [[nodiscard]] Vector3 along(const DraftDirection& direction) const;
  [[nodiscard]] Edge edge(const DraftDirection& direction);
  /// Index into Model::points() of a fixed point at 0, for unit vectors as differences; made where
  /// none is there.
  int zero();
  /// A fixed point of the model's own; its index there.
  int add_hidden(const std::string& name, bool is_vector);

  /// fixed . (the moving direction).
  [[nodiscard]] std::vector<Part> fixed_dot(const Vector3& fixed,
                                            const DraftDirection& moving) const;
  void refuse_same_dot(const JsonNode& node, const DraftDirection& first,
                       const DraftDirection& second);
  /// Writes a linear row; refused if another has the same coefficients.
  void distinct_linear(const JsonNode& node, const std::string& name,
                       const std::vector<Part>& parts, const TimeFunction& value);

  /// For outputs by the name of the rod or constraint.
  void remember(const JsonNode& node, Force force);
  [[nodiscard]] const std::unordered_map<std::string, Force>& forces() const { return forces_; }
  /// Of those that are torques, by whatever name: their rows pull along their directions, too.
  [[nodiscard]] const std::vector<Force>& torques() const { return torques_; }
  /// A constant distance between two points of the model.
  void keep_length(int a, int b, double length) { lengths_.emplace(std::minmax(a, b), length); }
  [[nodiscard]] std::optional<double> constant_length(const DraftDirection& direction) const;

 private:
  void number_points();
  void add_pusher(DraftForce& force);
  /// `point`, by another name where its own is taken; its index in the model.
  int add_hidden(DraftPoint point);
  void add_point(DraftPoint& point);
  [[nodiscard]] std::string velocity_path(const DraftPoint& point) const;
  void add_elements();

  SceneDraft& draft_;
  Lowered lowered_;
  RowWriter rows_;
  std::optional<MassWriter> mass_;
  int zero_ = -1;
  std::unordered_map<std::string, Force> forces_;   // of rods and constraints
  std::vector<Force> torques_;
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
