// Finds the few different Jacobian values of each constraint.
#include "pair_block.hpp"

#include <algorithm>
#include <utility>

namespace mbs::csc_cholmod {
namespace {

/// Factors of B^T u and B w in the Jacobian at `point`, added up over its roles. Eq. (7): B w at a,
/// -B w at b, B^T u at c, -B^T u at d.
std::pair<int, int> factors(const PairConstraint& c, int point) {
  return {(point == c.c) - (point == c.d), (point == c.a) - (point == c.b)};
}

}  // namespace

PairBlock::PairBlock(const std::vector<PairConstraint>& constraints, const Coordinates& coordinates,
                     const First& start, SignedRows& rows)
    : count(static_cast<int>(constraints.size())),
      dimension(coordinates.dimension()),
      first(start),
      value_start{0},
      product_start{0} {
  for (auto* places : {&a, &b, &c, &d}) places->resize(dimension * count);
  if (constraints.front().B != nullptr) matrix.resize(dimension * dimension * count);
  for (int k = 0; k < count; ++k) {
    add_places(constraints[k], k, coordinates);
    add_values(constraints[k], k, coordinates, rows);
    add_products();
  }
}

void PairBlock::add_places(const PairConstraint& constraint, int k,
                           const Coordinates& coordinates) {
  for (int axis = 0; axis < dimension; ++axis) {
    const int element = axis * count + k;
    a[element] = coordinates.place(constraint.a, axis);
    b[element] = coordinates.place(constraint.b, axis);
    c[element] = coordinates.place(constraint.c, axis);
    d[element] = coordinates.place(constraint.d, axis);
    if (constraint.B == nullptr) continue;
    for (int column = 0; column < dimension; ++column) {
      matrix[(axis * dimension + column) * count + k] = (*constraint.B)[axis][column];
    }
  }
}

void PairBlock::add_values(const PairConstraint& constraint, int k, const Coordinates& coordinates,
                           SignedRows& rows) {
  const int start = value_start.back();
  std::array points{constraint.a, constraint.b, constraint.c, constraint.d};
  std::sort(points.begin(), points.end());
  std::vector<std::pair<int, int>> kinds;  // factors met so far, up to their sign
  for (auto p = points.begin(); p != points.end(); p = std::upper_bound(p, points.end(), *p)) {
    auto [u, w] = factors(constraint, *p);
    if (!coordinates.is_unknown(coordinates.place(*p, 0)) || (u == 0 && w == 0)) continue;
    const bool negative = u < 0 || (u == 0 && w < 0);
    const std::pair<int, int> kind = negative ? std::pair(-u, -w) : std::pair(u, w);
    auto found = std::find(kinds.begin(), kinds.end(), kind);
    const int value = start + dimension * static_cast<int>(found - kinds.begin());
    const bool is_new = found == kinds.end();
    if (is_new) kinds.push_back(kind);
    for (int axis = 0; axis < dimension; ++axis) {
      rows.push({coordinates.place(*p, axis), first.value + value + axis, negative});
      if (!is_new) continue;
      source.push_back(axis * count + k);
      row.push_back(first.row + k);
      of_u.push_back(kind.first);
      of_w.push_back(kind.second);
    }
  }
  rows.end_row();
  value_start.push_back(values());
}

void PairBlock::add_products() {
  const int end = values();
  for (int i = value_start[value_start.size() - 2]; i < end; ++i) {
    for (int j = i; j < end; ++j) {
      left.push_back(first.value + i);
      right.push_back(first.value + j);
    }
  }
  product_start.push_back(products());
}

int PairBlock::product(int wanted_row, int i, int j) const {
  const int k = wanted_row - first.row;
  const int start = first.value + value_start[k];
  const int size = value_start[k + 1] - value_start[k];
  return first.product + product_start[k] + product_number(size, i - start, j - start);
}

}  // namespace mbs::csc_cholmod
