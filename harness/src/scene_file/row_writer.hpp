// Constraints on their way into ModelData: what is known goes to the right-hand side.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "mbs/model.hpp"
#include "model_math/vector3.hpp"

namespace mbs {

class RowWriter {
 public:
  /// r_a - r_b; indices into ModelData::points.
  struct Edge {
    int a = 0, b = 0;
  };
  /// coefficient times a coordinate of a point, free or not.
  struct Part {
    int point = 0, axis = 0;
    double coefficient = 0.0;
  };
  /// A constraint that is written: its place in Phi is known once all are.
  struct Row {
    enum class Kind { dot, bilinear, linear } kind = Kind::dot;
    std::size_t index = 0;  ///< in the list of its kind
  };

  explicit RowWriter(ModelData& data) : data_(data) {}

  Row dot(const std::string& name, Edge first, Edge second, const TimeFunction& value);
  Row bilinear(const std::string& name, Edge first, Edge second, const Matrix3& B,
               const TimeFunction& value);
  /// sum of parts = value. Fixed and driven points move to the value; parts of the same coordinate
  /// are summed up. At least one must be free (std::logic_error).
  Row linear(const std::string& name, const std::vector<Part>& parts, const TimeFunction& value);

  /// Index into Phi; valid once all are written.
  [[nodiscard]] int place(Row row) const;
  /// Writes the driven values.
  void finish();

 private:
  struct Driven {
    Row row;
    TimeFunction value;
  };
  double constant(Row row, const TimeFunction& value);
  const DrivenPoint* driven(int point);

  ModelData& data_;
  std::unordered_map<int, std::size_t> driven_points_;  // index into data_.driven_points
  std::vector<Driven> driven_;
};

}  // namespace mbs
