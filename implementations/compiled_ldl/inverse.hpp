// The inverse of the points' constant block A as a dense matrix.
#pragma once

#include <algorithm>

#include "panels/vectors.hpp"
#include "program.hpp"
#include "scalar.hpp"

namespace mbs::compiled_ldl {

/// Of all D axes, or of one where they are alike: A = diag(2, 2, 4, 4) in the plane is kept as
/// diag(½, ¼). As many rows as a register holds lie column by column.
template <int D>
class Inverse {
 public:
  /// Of `size` rows. `solve` replaces x, which is `padded`, by A⁻¹ x.
  template <typename Solve>
  Inverse(int size, int padded, bool axes_alike, Solve solve)
      : axes_(axes_alike ? D : 1),
        rows_(size / axes_),
        values_(static_cast<std::size_t>(rows_) * round_up(rows_, L), 0.0) {
    Array<double> x(padded);
    for (int j = 0; j < rows_; ++j) {
      std::fill(x.begin(), x.end(), 0.0);
      x[j * axes_] = 1.0;
      solve(x.data());
      for (int i = 0; i < rows_; ++i) values_[(i / L * rows_ + j) * L + i % L] = x[i * axes_];
    }
  }

  /// y += A⁻¹ x; y has L numbers behind its last row, which stay.
  void add_product(const double* x, double* y) const {
    axes_ == 1 ? add_products<1>(x, y) : add_products<D>(x, y);
  }

 private:
  static constexpr int L = kWidest<double>;
  using V = typename Short<double, L>::Type;

  template <int A>
  void add_products(const double* x, double* y) const {
    constexpr int R = A == 1 ? 4 : 2;  // sums enough to hide the latency of each
    int row = 0;
    for (; row + (R - 1) * L < rows_; row += R * L) add_rows<A, R>(x, y, row);
    for (; row < rows_; row += L) add_rows<A, 1>(x, y, row);
  }
  /// R vectors of rows, from `row` on.
  template <int A, int R>
  void add_rows(const double* x, double* y, int row) const;

  int axes_, rows_;
  Array<double> values_;
};

template <int D>
template <int A, int R>
void Inverse<D>::add_rows(const double* x, double* y, int row) const {
  const double* values = values_.data() + static_cast<std::size_t>(row) * rows_;
  V sums[R][A] = {};
  for (int j = 0; j < rows_; ++j) {
#pragma GCC unroll 4
    for (int r = 0; r < R; ++r) {
      const V value = load<double, L>(values + (r * rows_ + j) * L);
#pragma GCC unroll 3
      for (int a = 0; a < A; ++a) sums[r][a] += value * x[j * A + a];
    }
  }
  for (int r = 0; r < R; ++r) {
    double* to = y + (row + r * L) * A;
    if constexpr (A == 1) {
      store<double, L>(to, load<double, L>(to) + sums[r][0]);
    } else {
      const int count = std::min(L, rows_ - row - r * L);
      for (int i = 0; i < count; ++i) {
        for (int a = 0; a < A; ++a) to[i * A + a] += sums[r][a][i];
      }
    }
  }
}

}  // namespace mbs::compiled_ldl
