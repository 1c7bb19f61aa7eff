// Loops that add penalty r^T r to the tangent for rows r of Phi_q, Eq. (5).
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver.hpp"

namespace mbs::eigen_sparse {

/// A symmetric matrix as those see it who add products of derivatives by unknowns to its values.
struct Layout {
  const SparseMatrix* matrix;  ///< in its final pattern; nullptr: nothing will be added
  Triangle triangle;
  std::span<const int> place;  ///< row and column of each unknown; empty: as Coordinates has them
};

/// Where entry (row, col) is in the arrays of `matrix`.
int slot_of(const SparseMatrix& matrix, int row, int col);

/// Appends where the products (i, j) of a row with entries in `columns` go in the arrays of a
/// matrix: for i ascending all j, or for the upper triangle alone those with j <= i.
void append_slots(const Layout& layout, std::span<const int> columns, std::vector<int>& slots);

/// Adds penalty r^T r for each of `count` rows r of equal width, one after another in `rows`, to
/// the values of the tangent; `slots` as append_slots() lists them for one row after another.
using AddRows = void (*)(const double* rows, const int* slots, int count, double penalty,
                         double* tangent);

template <int kWidth, Triangle kTriangle>
void add_rows(const double* rows, const int* slots, int count, double penalty, double* tangent) {
  for (int k = 0; k < count; ++k, rows += kWidth) {
    for (int i = 0; i < kWidth; ++i) {
      const double scaled = penalty * rows[i];
      const int end = kTriangle == Triangle::full ? kWidth : i + 1;
      for (int j = 0; j < end; ++j) tangent[*slots++] += scaled * rows[j];
    }
  }
}

/// The loop for rows of `width` entries: those of up to 4 free points in 2 or 3 dimensions.
template <Triangle kTriangle>
AddRows loop_for(int width) {
  switch (width) {
    case 0:
      return add_rows<0, kTriangle>;
    case 2:
      return add_rows<2, kTriangle>;
    case 3:
      return add_rows<3, kTriangle>;
    case 4:
      return add_rows<4, kTriangle>;
    case 6:
      return add_rows<6, kTriangle>;
    case 8:
      return add_rows<8, kTriangle>;
    case 9:
      return add_rows<9, kTriangle>;
    case 12:
      return add_rows<12, kTriangle>;
  }
  throw std::logic_error("no loop for rows of " + std::to_string(width) + " entries");
}
AddRows loop_for(Triangle triangle, int width);

}  // namespace mbs::eigen_sparse
