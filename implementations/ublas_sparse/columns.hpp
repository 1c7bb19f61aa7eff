// Which columns of Phi_q the points of a quadratic constraint fill, coincident points merged.
#pragma once

#include <vector>

#include "points.hpp"

namespace mbs::ublas_sparse {

/// Phi_q(row, point + k) = by_cd (B w)_k + by_ab (B^T u)_k of Eq. (7), u = r_a - r_b, w = r_c -
/// r_d; for a dot constraint B is the identity.
struct Column {
  int point;  // free
  double by_cd, by_ab;
};

/// A quadratic constraint: its points by first coordinate, and its part of a list of columns.
struct Quadratic {
  int row, a, b, c, d;
  int columns_begin = 0, columns_end = 0;
};

/// Appends the columns of `constraint`, each free point once, and notes where they are.
void append_columns(const Points& points, Quadratic& constraint, std::vector<Column>& columns);

/// Appends a zero for every position that `constraint` fills.
void append_positions(const Points& points, const Quadratic& constraint,
                      const std::vector<Column>& columns, std::vector<Entry>& entries);

}  // namespace mbs::ublas_sparse
