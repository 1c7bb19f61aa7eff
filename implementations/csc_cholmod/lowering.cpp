// Sorts constraints into blocks and records which Jacobian value goes into which column.
#include "lowering.hpp"

#include <cstddef>

namespace mbs::csc_cholmod {
namespace {

bool is_distance(const DotConstraint& c) { return c.a == c.c && c.b == c.d && c.a != c.b; }

std::vector<PairConstraint> other_dots(const Model& model) {
  std::vector<PairConstraint> result;
  for (const DotConstraint& c : model.dot_constraints()) {
    if (!is_distance(c)) result.push_back({c.a, c.b, c.c, c.d, nullptr});
  }
  return result;
}

std::vector<PairConstraint> bilinears(const Model& model) {
  std::vector<PairConstraint> result;
  for (const BilinearConstraint& c : model.bilinear_constraints()) {
    result.push_back({c.a, c.b, c.c, c.d, &c.B});
  }
  return result;
}

}  // namespace

LoweredConstraints::LoweredConstraints(const Model& model, const Coordinates& coordinates)
    : dimension(model.dimension()), target(model.constraints()), row_(model.constraints()) {
  number_rows(model);
  add_distances(model, coordinates);
  add_pairs(other_dots(model), coordinates);
  add_pairs(bilinears(model), coordinates);
  add_linear(model, coordinates);
}

void LoweredConstraints::number_rows(const Model& model) {
  const auto dots = model.dot_constraints();
  int next = 0;
  for (const bool distances : {true, false}) {
    for (std::size_t k = 0; k < dots.size(); ++k) {
      if (is_distance(dots[k]) == distances) row_[k] = next++;
    }
    if (distances) distance.count = next;
  }
  for (std::size_t k = dots.size(); k < row_.size(); ++k) row_[k] = next++;
  int k = 0;
  for (const DotConstraint& c : dots) target[row_[k++]] = c.value;
  for (const BilinearConstraint& c : model.bilinear_constraints()) target[row_[k++]] = c.value;
  for (const LinearConstraint& c : model.linear_constraints()) target[row_[k++]] = c.value;
}

void LoweredConstraints::add_distances(const Model& model, const Coordinates& coordinates) {
  const int count = distance.count;
  distance.plus.resize(dimension * count);
  distance.minus.resize(dimension * count);
  int k = 0;
  for (const DotConstraint& constraint : model.dot_constraints()) {
    if (!is_distance(constraint)) continue;
    for (int axis = 0; axis < dimension; ++axis) {
      const int value = axis * count + k;
      const int plus = distance.plus[value] = coordinates.place(constraint.a, axis);
      const int minus = distance.minus[value] = coordinates.place(constraint.b, axis);
      if (coordinates.is_unknown(plus)) entries_.push({plus, value, false});
      if (coordinates.is_unknown(minus)) entries_.push({minus, value, true});
    }
    entries_.end_row();
    ++k;
  }
  next_ = {count, dimension * count, product_count(dimension) * count};
}

void LoweredConstraints::add_pairs(const std::vector<PairConstraint>& constraints,
                                   const Coordinates& coordinates) {
  if (constraints.empty()) return;
  const PairBlock& block = pairs.emplace_back(constraints, coordinates, next_, entries_);
  next_.row += block.count;
  next_.value += block.values();
  next_.product += block.products();
}

void LoweredConstraints::add_linear(const Model& model, const Coordinates& coordinates) {
  linear.first_row = next_.row;
  linear.count = static_cast<int>(model.linear_constraints().size());
  linear.start = {0};
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    for (const LinearConstraint::Term& term : constraint.terms) {
      linear.column.push_back(coordinates.number()[term.coordinate]);
      linear.row.push_back(next_.row);
      linear.coefficient.push_back(term.coefficient);
    }
    linear.start.push_back(static_cast<int>(linear.column.size()));
    ++next_.row;
  }
}

int LoweredConstraints::product(int row, int i, int j) const {
  if (row < distance.count) {
    // Runs over the constraints for the axes 00, 01, 11 (3D: 00, 01, 02, 11, 12, 22).
    const int axes = product_number(dimension, i / distance.count, j / distance.count);
    return axes * distance.count + row;
  }
  const PairBlock& block =
      row < pairs.front().first.row + pairs.front().count ? pairs.front() : pairs.back();
  return block.product(row, i, j);
}

}  // namespace mbs::csc_cholmod
