// Set-up of an Assembly: flat lists of constraints, non-zeros and products.
#include <algorithm>
#include <string>

#include "assembly.hpp"
#include "mbs/simulation.hpp"

namespace mbs::starting_sparse {
namespace {

constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;

void require_at_most_one_gibibyte(double bytes, const std::string& what) {
  if (bytes <= kGibibyte) return;
  throw Unsupported(what + " would take " + std::to_string(bytes / kGibibyte) +
                    " GiB, allowed is 1 GiB");
}

}  // namespace

Assembly::Assembly(const Model& model, double weight, double penalty)
    : variables_(model.variables()),
      constraints_(model.constraints()),
      dimension_(model.dimension()),
      dot_count_(static_cast<int>(model.dot_constraints().size())),
      weight_(weight),
      penalty_(penalty),
      force_(model.force()),
      linear_(model.linear_constraints()),
      phi_(constraints_),
      multiplier_(constraints_),
      stride_(variables_ + dimension_) {
  require_memory(model);
  number_points(model);
  jacobian_.resize(static_cast<std::size_t>(constraints_) * stride_);
  append_mass(model);
  row_start_.push_back(0);
  int row = 0;
  for (const DotConstraint& constraint : model.dot_constraints()) append_dot(row++, constraint);
  for (const LinearConstraint& constraint : linear_) append_linear(row++, constraint);
}

void Assembly::require_memory(const Model& model) const {
  require_at_most_one_gibibyte(8.0 * constraints_ * stride_,
                               "the dense Jacobian, " + std::to_string(constraints_) + " x " +
                                   std::to_string(variables_) + ",");
  const double width = 4.0 * dimension_;
  double entries = model.mass().size() + dot_count_ * width * (width + 1) / 2;
  for (const LinearConstraint& constraint : linear_) {
    entries += 0.5 * constraint.terms.size() * (constraint.terms.size() + 1.0);
  }
  require_at_most_one_gibibyte(16.0 * entries, "the coordinate list of the tangent matrix");
}

void Assembly::number_points(const Model& model) {
  for (const Point& point : model.points()) {
    if (point.is_fixed()) {
      point_offset_.push_back(variables_ + static_cast<int>(fixed_.size()));
      fixed_.insert(fixed_.end(), point.position.begin(), point.position.begin() + dimension_);
    } else {
      point_offset_.push_back(point.offset);
    }
  }
}

void Assembly::append_mass(const Model& model) {
  const auto append = [this](const MassEntry& entry) {
    rows_.push_back(entry.row + 1);
    columns_.push_back(entry.col + 1);
    values_.push_back(entry.value);
  };
  for (const MassEntry& entry : model.mass()) {
    if (entry.row == entry.col) append(entry);  // sorted by column: entry i is M(i, i)
  }
  for (const MassEntry& entry : model.mass()) {
    if (entry.row != entry.col) append(entry);
  }
  mass_count_ = static_cast<int>(values_.size());
}

void Assembly::append_dot(int row, const DotConstraint& constraint) {
  const auto place = [&](int offset) { return row * stride_ + std::min(offset, variables_); };
  const int a = point_offset_[constraint.a], b = point_offset_[constraint.b];
  const int c = point_offset_[constraint.c], d = point_offset_[constraint.d];
  if (a == c && b == d && a != b) {
    distances_.push_back({row, a, b, place(a), place(b), constraint.value});
  } else {
    dots_.push_back({row, a, b, c, d, place(a), place(b), place(c), place(d), constraint.value});
  }
  std::vector<int> columns;
  for (int offset : {a, b, c, d}) {
    if (offset >= variables_) continue;
    for (int axis = 0; axis < dimension_; ++axis) columns.push_back(offset + axis);
  }
  append_row(row, columns, false);
}

void Assembly::append_linear(int row, const LinearConstraint& constraint) {
  std::vector<int> columns;
  for (const LinearConstraint::Term& term : constraint.terms) {
    jacobian_[row * stride_ + term.coordinate] = term.coefficient;  // Eq. (8), constant
    columns.push_back(term.coordinate);
  }
  append_row(row, columns, true);
}

/// The symbolic part of one row of Phi_q: its non-zeros and their products. `columns` (any order,
/// repeated) arrives unsorted; products of a constant row are written here and never again.
void Assembly::append_row(int row, std::vector<int>& columns, bool is_constant) {
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  const int first = row * stride_;
  for (int column : columns) {
    nonzero_place_.push_back(first + column);
    nonzero_column_.push_back(column);
  }
  row_start_.push_back(static_cast<int>(nonzero_place_.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const int left = first + columns[i], right = first + columns[j];
      rows_.push_back(columns[i] + 1);
      columns_.push_back(columns[j] + 1);
      values_.push_back(is_constant ? weight_ * penalty_ * jacobian_[left] * jacobian_[right] : 0);
      if (is_constant) continue;
      left_.push_back(left);
      right_.push_back(right);
    }
  }
}

}  // namespace mbs::starting_sparse
