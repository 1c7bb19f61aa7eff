// Loops that add penalty r^T r to the tangent for rows r of Phi_q, Eq. (5).
#pragma once

#include "solver.hpp"

namespace mbs::eigen_superlu {

/// Adds penalty r^T r for each of `count` rows r of equal width, one after another in `rows`, to
/// the values of the tangent. For each row, `slots` says where its products (i, j) go: for i
/// ascending all j, or for the upper triangle alone those with j <= i.
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

/// The loop for rows of `width` entries: those of 1 to 4 free points in 2 or 3 dimensions.
template <Triangle kTriangle>
AddRows loop_for(int width) {
  switch (width) {
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
    default:
      return add_rows<12, kTriangle>;
  }
}

}  // namespace mbs::eigen_superlu
