// Set-up of the constraints (pattern of Phi_q, order of writing, constant rows), M and drivers.
#include <algorithm>
#include <utility>

#include "assembly_builder.hpp"

namespace mbs::csc_mumps {

Assembly::Assembly(const Model& model, double step)
    : variables_(model.variables()),
      dimension_(model.dimension()),
      quarter_(step * step / 4.0),
      force_(model.force()),
      linear_row_(
          static_cast<int>(model.dot_constraints().size() + model.bilinear_constraints().size())),
      phi_(model.constraints()) {
  Builder(*this, model).build(step);
}

void Assembly::Builder::build(double step) {
  collect_rows();
  compress_jacobian();
  lower_products();
  lower_linear();
  self_.forces_ = Forces(model_, points_, step);
  attach_drivers();
  build_mass();
  self_.fixed_coordinates_ = std::move(points_.fixed);
  if (!self_.drivers_.empty()) {
    self_.evaluated_.resize(self_.variables_ + self_.fixed_coordinates_.size());
  }
}

void Assembly::Builder::collect_rows() {
  columns_of_.reserve(model_.constraints());
  for (const DotConstraint& dot : model_.dot_constraints()) {
    columns_of_.push_back(points_.columns({dot.a, dot.b, dot.c, dot.d}));
  }
  for (const BilinearConstraint& bilinear : model_.bilinear_constraints()) {
    columns_of_.push_back(points_.columns({bilinear.a, bilinear.b, bilinear.c, bilinear.d}));
  }
  for (const LinearConstraint& linear : model_.linear_constraints()) {
    std::vector<int>& columns = columns_of_.emplace_back();
    for (const LinearConstraint::Term& term : linear.terms) columns.push_back(term.coordinate);
    std::sort(columns.begin(), columns.end());
  }
}

void Assembly::Builder::compress_jacobian() {
  std::vector<int>& start = self_.jacobian_pattern_.start;
  start.assign(self_.variables_ + 1, 0);
  for (const auto& columns : columns_of_) {
    for (int column : columns) ++start[column + 1];
  }
  for (int j = 0; j < self_.variables_; ++j) start[j + 1] += start[j];
  self_.jacobian_pattern_.row.resize(start.back());
  self_.jacobian_.resize(start.back() + 1);
  std::vector<int> next(start.begin(), start.end() - 1);
  for (int row = 0; row < static_cast<int>(columns_of_.size()); ++row) {
    for (int column : columns_of_[row]) self_.jacobian_pattern_.row[next[column]++] = row;
  }
}

/// Where Phi_q(row, column) is in jacobian_; the entry behind the last one for fixed points.
int Assembly::Builder::place(int row, int column) const {
  const ColumnPattern& pattern = self_.jacobian_pattern_;
  return points_.is_free(column) ? pattern.entry(row, column)
                                 : static_cast<int>(pattern.row.size());
}

std::array<int, Assembly::kPointsOfDot> Assembly::Builder::offsets(int a, int b, int c,
                                                                   int d) const {
  const std::vector<int>& offset = points_.offset;
  return {offset[a], offset[b], offset[c], offset[d]};
}

/// Dot and bilinear constraints. Distances are evaluated first, then general dot constraints.
void Assembly::Builder::lower_products() {
  int row = 0;
  for (const DotConstraint& dot : model_.dot_constraints()) {
    const auto [a, b, c, d] = offsets(dot.a, dot.b, dot.c, dot.d);
    if (a == c && b == d && a != b) {
      self_.distances_.push_back({a, b, row, dot.value});
    } else {
      self_.dots_.push_back({a, b, c, d, row, dot.value});
    }
    ++row;
  }
  for (const BilinearConstraint& bilinear : model_.bilinear_constraints()) {
    const auto [a, b, c, d] = offsets(bilinear.a, bilinear.b, bilinear.c, bilinear.d);
    self_.bilinears_.push_back({{a, b, c, d, row, bilinear.value}, bilinear.B});
    ++row;
  }
  for (const Distance& distance : self_.distances_) lower_distance(distance);
  for (const Dot& dot : self_.dots_) lower_gradients(dot);
  for (const Bilinear& bilinear : self_.bilinears_) lower_gradients(bilinear);
}

void Assembly::Builder::lower_distance(const Distance& distance) {
  for (int axis = 0; axis < self_.dimension_; ++axis) {
    self_.write_order_.push_back(place(distance.row, distance.first + axis));
    self_.write_order_.push_back(place(distance.row, distance.second + axis));
  }
}

void Assembly::Builder::lower_gradients(const Dot& dot) {
  const std::array<int, kPointsOfDot> at = {dot.a, dot.b, dot.c, dot.d};
  // Point p appears first at slot s: it takes every share of p; later slots of p write nowhere.
  const auto is_first = [&](int s) {
    return std::find(at.begin(), at.end(), at[s]) - at.begin() == s;
  };
  for (int s = 0; s < kPointsOfDot; ++s) {
    const auto at_s = [&](int slot) { return at[slot] == at[s] ? 1.0 : 0.0; };
    self_.gradients_.push_back({at_s(0) - at_s(1), at_s(2) - at_s(3)});
  }
  for (int axis = 0; axis < self_.dimension_; ++axis) {
    for (int s = 0; s < kPointsOfDot; ++s) {
      const int column = is_first(s) ? at[s] + axis : self_.variables_;
      self_.write_order_.push_back(place(dot.row, column));
    }
  }
}

void Assembly::Builder::lower_linear() {
  int row = self_.linear_row_;
  self_.linear_start_.push_back(0);
  for (const LinearConstraint& linear : model_.linear_constraints()) {
    for (const LinearConstraint::Term& term : linear.terms) {
      self_.linear_terms_.push_back(term);
      self_.jacobian_[place(row, term.coordinate)] = term.coefficient;  // Eq. (8), constant
    }
    self_.linear_start_.push_back(static_cast<int>(self_.linear_terms_.size()));
    self_.linear_value_.push_back(linear.value);
    ++row;
  }
}

void Assembly::Builder::build_mass() {
  self_.mass_pattern_.start.assign(self_.variables_ + 1, 0);
  for (const MassEntry& entry : model_.mass()) {
    ++self_.mass_pattern_.start[entry.col + 1];
    self_.mass_pattern_.row.push_back(entry.row);
    self_.mass_.push_back(entry.value);
  }
  for (int j = 0; j < self_.variables_; ++j) {
    self_.mass_pattern_.start[j + 1] += self_.mass_pattern_.start[j];
  }
}

/// Tells the drivers where the constraints, all of them in place by now, keep their values.
void Assembly::Builder::attach_drivers() {
  std::vector<double*> values;
  if (!model_.driven_values().empty()) {
    values.resize(model_.constraints());
    for (Distance& distance : self_.distances_) values[distance.row] = &distance.value;
    for (Dot& dot : self_.dots_) values[dot.row] = &dot.value;
    for (Bilinear& bilinear : self_.bilinears_) values[bilinear.row] = &bilinear.value;
    int row = self_.linear_row_;
    for (double& value : self_.linear_value_) values[row++] = &value;
  }
  self_.drivers_ = Drivers(model_, points_, values);
}

}  // namespace mbs::csc_mumps
