// Sorts constraints into blocks and records which Jacobian value goes into which column.
#include "lowering.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace mbs::csc_cholmod {
namespace {

bool is_distance(const DotConstraint& c) { return c.a == c.c && c.b == c.d && c.a != c.b; }

/// Factors of u and w in the Jacobian at `point`, added up over its roles. Eq. (7): w at a, -w at
/// b, u at c, -u at d.
std::pair<int, int> factors(const DotConstraint& c, int point) {
  return {(point == c.c) - (point == c.d), (point == c.a) - (point == c.b)};
}

}  // namespace

Coordinates::Coordinates(const Model& model, std::vector<int> number)
    : dimension_(model.dimension()), number_(std::move(number)) {
  for (const Point& point : model.points()) {
    for (int axis = 0; axis < dimension_; ++axis) {
      if (point.is_fixed()) {
        place_.push_back(all());
        constants_.push_back(point.position[axis]);
      } else {
        place_.push_back(number_[point.offset + axis]);
      }
    }
  }
}

LoweredConstraints::LoweredConstraints(const Model& model, const Coordinates& coordinates)
    : dimension(model.dimension()), row_(model.constraints()) {
  int next = 0;  // a row
  const auto dots = model.dot_constraints();
  for (const bool distances : {true, false}) {
    for (std::size_t k = 0; k < dots.size(); ++k) {
      if (is_distance(dots[k]) == distances) row_[k] = next++;
    }
    (distances ? distance.count : dot.count) = next - distance.count;
  }
  for (std::size_t k = dots.size(); k < row_.size(); ++k) row_[k] = next++;
  add_distances(model, coordinates);
  add_dots(model, coordinates);
  add_linear(model, coordinates);
}

void LoweredConstraints::add_distances(const Model& model, const Coordinates& coordinates) {
  const int count = distance.count;
  distance.plus.resize(dimension * count);
  distance.minus.resize(dimension * count);
  int k = 0;
  for (const DotConstraint& constraint : model.dot_constraints()) {
    if (!is_distance(constraint)) continue;
    distance.squared_length.push_back(constraint.value);
    for (int axis = 0; axis < dimension; ++axis) {
      const int value = axis * count + k;
      const int plus = distance.plus[value] = coordinates.place(constraint.a, axis);
      const int minus = distance.minus[value] = coordinates.place(constraint.b, axis);
      if (coordinates.is_unknown(plus)) entries_.push_back({plus, value, false});
      if (coordinates.is_unknown(minus)) entries_.push_back({minus, value, true});
    }
    entry_start_.push_back(static_cast<int>(entries_.size()));
    ++k;
  }
}

void LoweredConstraints::add_dots(const Model& model, const Coordinates& coordinates) {
  for (auto* places : {&dot.a, &dot.b, &dot.c, &dot.d}) places->resize(dimension * dot.count);
  dot.value_start = dot.product_start = {0};
  int k = 0;
  for (const DotConstraint& constraint : model.dot_constraints()) {
    if (is_distance(constraint)) continue;
    dot.target.push_back(constraint.value);
    for (int axis = 0; axis < dimension; ++axis) {
      const int element = axis * dot.count + k;
      dot.a[element] = coordinates.place(constraint.a, axis);
      dot.b[element] = coordinates.place(constraint.b, axis);
      dot.c[element] = coordinates.place(constraint.c, axis);
      dot.d[element] = coordinates.place(constraint.d, axis);
    }
    add_dot_values(constraint, k++, coordinates);
  }
}

void LoweredConstraints::add_dot_values(const DotConstraint& constraint, int k,
                                        const Coordinates& coordinates) {
  const int offset = dimension * distance.count;  // of the block's values among all
  const int first = dot.value_start.back();
  std::array points{constraint.a, constraint.b, constraint.c, constraint.d};
  std::sort(points.begin(), points.end());
  std::vector<std::pair<int, int>> kinds;  // factors met so far, up to their sign
  for (auto p = points.begin(); p != points.end(); p = std::upper_bound(p, points.end(), *p)) {
    auto [of_u, of_w] = factors(constraint, *p);
    if (!coordinates.is_unknown(coordinates.place(*p, 0)) || (of_u == 0 && of_w == 0)) continue;
    const bool negative = of_u < 0 || (of_u == 0 && of_w < 0);
    const std::pair<int, int> kind = negative ? std::pair(-of_u, -of_w) : std::pair(of_u, of_w);
    auto found = std::find(kinds.begin(), kinds.end(), kind);
    const int value = first + dimension * static_cast<int>(found - kinds.begin());
    const bool is_new = found == kinds.end();
    if (is_new) kinds.push_back(kind);
    for (int axis = 0; axis < dimension; ++axis) {
      entries_.push_back({coordinates.place(*p, axis), offset + value + axis, negative});
      if (!is_new) continue;
      dot.source.push_back(axis * dot.count + k);
      dot.row.push_back(k);
      dot.of_u.push_back(kind.first);
      dot.of_w.push_back(kind.second);
    }
  }
  entry_start_.push_back(static_cast<int>(entries_.size()));
  const int end = static_cast<int>(dot.source.size());
  for (int i = first; i < end; ++i) {
    for (int j = i; j < end; ++j) {
      dot.left.push_back(offset + i);
      dot.right.push_back(offset + j);
    }
  }
  dot.value_start.push_back(end);
  dot.product_start.push_back(static_cast<int>(dot.left.size()));
}

void LoweredConstraints::add_linear(const Model& model, const Coordinates& coordinates) {
  linear.count = static_cast<int>(model.linear_constraints().size());
  linear.start = {0};
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    for (const LinearConstraint::Term& term : constraint.terms) {
      linear.column.push_back(coordinates.number()[term.coordinate]);
      linear.row.push_back(static_cast<int>(linear.target.size()));
      linear.coefficient.push_back(term.coefficient);
    }
    linear.target.push_back(constraint.value);
    linear.start.push_back(static_cast<int>(linear.column.size()));
  }
}

int LoweredConstraints::product(int row, int i, int j) const {
  if (row < distance.count) {
    // Runs over the constraints for the axes 00, 01, 11 (3D: 00, 01, 02, 11, 12, 22).
    const auto [low, high] = std::minmax({i / distance.count, j / distance.count});
    return (low * dimension - low * (low - 1) / 2 + high - low) * distance.count + row;
  }
  const int k = row - distance.count;
  const int offset = dimension * distance.count + dot.value_start[k];
  const int size = dot.value_start[k + 1] - dot.value_start[k];
  const auto [low, high] = std::minmax({i - offset, j - offset});
  return first_dot_product() + dot.product_start[k] + low * size - low * (low - 1) / 2 + high - low;
}

}  // namespace mbs::csc_cholmod
