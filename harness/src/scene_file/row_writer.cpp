// Driven values wait until the number of quadratic rows is known.
#include "scene_file/row_writer.hpp"

#include <algorithm>
#include <stdexcept>

#include "scene/time_functions.hpp"

namespace mbs {

double RowWriter::constant(Row row, const TimeFunction& value) {
  if (!value.is_constant()) driven_.push_back({row, value});
  return value.at(0.0).value;
}

RowWriter::Row RowWriter::dot(const std::string& name, Edge first, Edge second,
                              const TimeFunction& value) {
  const Row row{Row::Kind::dot, data_.dot_constraints.size()};
  data_.dot_constraints.push_back(
      {first.a, first.b, second.a, second.b, constant(row, value), name});
  return row;
}

RowWriter::Row RowWriter::bilinear(const std::string& name, Edge first, Edge second,
                                   const Matrix3& B, const TimeFunction& value) {
  const Row row{Row::Kind::bilinear, data_.bilinear_constraints.size()};
  data_.bilinear_constraints.push_back(
      {first.a, first.b, second.a, second.b, B, constant(row, value), name});
  return row;
}

const DrivenPoint* RowWriter::driven(int point) {
  while (driven_points_.size() < data_.driven_points.size()) {  // those added since the last time
    const std::size_t next = driven_points_.size();
    driven_points_.emplace(data_.driven_points[next].point, next);
  }
  const auto found = driven_points_.find(point);
  return found == driven_points_.end() ? nullptr : &data_.driven_points[found->second];
}

RowWriter::Row RowWriter::linear(const std::string& name, const std::vector<Part>& parts,
                                 const TimeFunction& value) {
  LinearConstraint constraint{{}, 0.0, name};
  Summands known{{1.0, value}};
  double fixed = 0.0;
  for (const Part& part : parts) {
    if (part.coefficient == 0.0) continue;
    const Point& point = data_.points[static_cast<std::size_t>(part.point)];
    const auto axis = static_cast<std::size_t>(part.axis);
    if (!point.is_fixed()) {
      constraint.terms.push_back({point.offset + part.axis, part.coefficient});
    } else if (const DrivenPoint* motion = driven(part.point)) {
      known.emplace_back(-part.coefficient, motion->position[axis]);
    } else {
      fixed -= part.coefficient * point.position[axis];
    }
  }
  auto& terms = constraint.terms;
  if (terms.empty()) throw std::logic_error("constraint '" + name + "' has no coordinate");
  std::sort(terms.begin(), terms.end(),
            [](const auto& x, const auto& y) { return x.coordinate < y.coordinate; });
  auto last = terms.begin();
  for (auto term = terms.begin() + 1; term != terms.end(); ++term) {
    if (term->coordinate == last->coordinate) {
      last->coefficient += term->coefficient;
    } else {
      *++last = *term;
    }
  }
  terms.erase(last + 1, terms.end());
  const Row row{Row::Kind::linear, data_.linear_constraints.size()};
  constraint.value = constant(row, combination(known, fixed));
  data_.linear_constraints.push_back(std::move(constraint));
  return row;
}

int RowWriter::place(Row row) const {
  std::size_t index = row.index;
  if (row.kind != Row::Kind::dot) index += data_.dot_constraints.size();
  if (row.kind == Row::Kind::linear) index += data_.bilinear_constraints.size();
  return static_cast<int>(index);
}

void RowWriter::finish() {
  for (Driven& driven : driven_) {
    data_.driven_values.push_back({place(driven.row), std::move(driven.value)});
  }
  driven_.clear();
}

}  // namespace mbs
