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

Assembly::Assembly(const Model& model, const StepSettings& settings)
    : variables_(model.variables()),
      constraints_(model.constraints()),
      dimension_(model.dimension()),
      quadratic_count_(constraints_ - static_cast<int>(model.linear_constraints().size())),
      weight_(0.25 * settings.step * settings.step),
      penalty_(settings.penalty),
      point_offset_(number_points(model)),
      drivers_(model, point_offset_),
      forces_(model, point_offset_, settings.step),
      force_(drivers_.force()),
      phi_(constraints_),
      multiplier_(constraints_),
      stride_(variables_ + dimension_) {
  require_memory(model);
  if (is_driven()) evaluated_.resize(variables_ + fixed_.size());
  jacobian_.resize(static_cast<std::size_t>(constraints_) * stride_);
  append_mass(model);
  row_start_.push_back(0);
  const auto append_all = [this](const auto& constraints, auto append) {
    for (const auto& constraint : constraints) {
      (this->*append)(static_cast<int>(value_.size()), constraint);
      value_.push_back(constraint.value);
    }
  };
  append_all(model.dot_constraints(), &Assembly::append_dot);
  append_all(model.bilinear_constraints(), &Assembly::append_bilinear);
  append_all(model.linear_constraints(), &Assembly::append_linear);
  forces_first_ = static_cast<int>(values_.size());
  forces_.append_positions(rows_, columns_);
  values_.resize(rows_.size());
}

void Assembly::require_memory(const Model& model) const {
  require_at_most_one_gibibyte(8.0 * constraints_ * stride_,
                               "the dense Jacobian, " + std::to_string(constraints_) + " x " +
                                   std::to_string(variables_) + ",");
  const double width = 4.0 * dimension_;
  const double full = static_cast<double>(quadratic_count_) + model.torsion_springs().size() +
                      model.springs().size();
  double entries = model.mass().size() + full * width * (width + 1) / 2;
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    entries += 0.5 * constraint.terms.size() * (constraint.terms.size() + 1.0);
  }
  require_at_most_one_gibibyte(16.0 * entries, "the coordinate list of the tangent matrix");
}

/// Offsets of the points in an extended vector; fills fixed_.
std::vector<int> Assembly::number_points(const Model& model) {
  std::vector<int> offsets;
  for (const Point& point : model.points()) {
    if (point.is_fixed()) {
      offsets.push_back(variables_ + static_cast<int>(fixed_.size()));
      fixed_.insert(fixed_.end(), point.position.begin(), point.position.begin() + dimension_);
    } else {
      offsets.push_back(point.offset);
    }
  }
  return offsets;
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
  const Dot dot = locate(row, constraint.a, constraint.b, constraint.c, constraint.d);
  if (dot.a == dot.c && dot.b == dot.d && dot.a != dot.b) {
    distances_.push_back({row, dot.a, dot.b, dot.to_a, dot.to_b});
  } else {
    dots_.push_back(dot);
  }
  append_quadratic_row(dot);
}

void Assembly::append_bilinear(int row, const BilinearConstraint& constraint) {
  const Dot dot = locate(row, constraint.a, constraint.b, constraint.c, constraint.d);
  bilinears_.push_back({dot, constraint.B});
  append_quadratic_row(dot);
}

/// Where a constraint on points a, b, c and d reads and writes.
Assembly::Dot Assembly::locate(int row, int a, int b, int c, int d) const {
  Dot dot{row, point_offset_[a], point_offset_[b], point_offset_[c], point_offset_[d], 0, 0, 0, 0};
  const auto place = [&](int offset) { return row * stride_ + std::min(offset, variables_); };
  dot.to_a = place(dot.a);
  dot.to_b = place(dot.b);
  dot.to_c = place(dot.c);
  dot.to_d = place(dot.d);
  return dot;
}

void Assembly::append_quadratic_row(const Dot& dot) {
  std::vector<int> columns;
  for (int offset : {dot.a, dot.b, dot.c, dot.d}) {
    if (offset >= variables_) continue;
    for (int axis = 0; axis < dimension_; ++axis) columns.push_back(offset + axis);
  }
  append_row(dot.row, columns, false);
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
