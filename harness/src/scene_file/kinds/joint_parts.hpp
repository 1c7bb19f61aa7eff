// What several kinds of joints are made of.
#pragma once

#include <string>
#include <vector>

#include "scene_file/lowering.hpp"
#include "scene_file/scene_reader.hpp"

namespace mbs {

/// "point" and "line", in space "direction" too, as on_line has them.
void read_line(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint);
void write_line_rows(Lowering& scene, const DraftConstraint& constraint);

/// In space: "axis", a unit vector that stays parallel to the line.
void read_axis(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint);
void write_parallel_rows(Lowering& scene, const DraftConstraint& constraint);

void write_coincident_rows(Lowering& scene, const DraftConstraint& constraint);

/// first . second = 0; both must have a length above 0, and one must move.
void write_perpendicular_row(Lowering& scene, const DraftConstraint& constraint,
                             const std::string& name, const DraftDirection& first,
                             const DraftDirection& second);

/// In the plane: the angle from the constraint's first to its second direction stays what it is.
void write_kept_angle_row(Lowering& scene, const DraftConstraint& constraint);

/// Where the rows of a model end.
class RowMark {
 public:
  explicit RowMark(const ModelData& data);
  /// The rows written since.
  [[nodiscard]] std::vector<Lowering::Row> rows(const ModelData& data) const;

 private:
  std::size_t dots_, bilinears_, linears_;
};

}  // namespace mbs
