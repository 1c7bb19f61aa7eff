// The block of a panel's pivots in scalars, where registers hold half of its columns at most.
#pragma once

#include <type_traits>

#include "panels/block.hpp"
#include "panels/vectors.hpp"

namespace mbs::compiled_ldl {

/// Half of what vectors of eight numbers in two registers take up is not below the diagonal, and
/// each column waits for multipliers that are taken out of the one before. Scalars have nothing but
/// the triangle, and wait for no narrow stores of elements.
template <typename F>
inline constexpr bool kInScalars = std::is_same_v<typename Short<F, 8>::Type, Halves>;

/// body(i) of kBegin … kEnd - 1, which are constants there.
template <int kBegin, int kEnd, typename Body>
[[gnu::always_inline]] inline void unrolled(Body body) {
  if constexpr (kBegin < kEnd) {
    body(std::integral_constant<int, kBegin>{});
    unrolled<kBegin + 1, kEnd>(body);
  }
}

/// As a vector, zeros behind the last one.
template <int N, typename F, int P>
[[gnu::always_inline]] inline typename Short<F, N>::Type vector_of(const F (&x)[P]) {
  const auto at = [&](auto i) __attribute__((always_inline)) {
    if constexpr (i < P) {
      return x[i];
    } else {
      return F(0);
    }
  };
  using std::integral_constant;
  const auto four = [&](auto i) __attribute__((always_inline)) {
    constexpr int k = i;
    return typename Short<F, 4>::Type{
        at(integral_constant<int, k>{}), at(integral_constant<int, k + 1>{}),
        at(integral_constant<int, k + 2>{}), at(integral_constant<int, k + 3>{})};
  };
  if constexpr (N == 4) {
    return four(integral_constant<int, 0>{});
  } else {
    static_assert(std::is_same_v<typename Short<F, N>::Type, Halves>);
    return {four(integral_constant<int, 0>{}), four(integral_constant<int, 4>{})};
  }
}

/// Takes pivots k and k + 1 out of what is behind them of the columns a and of the right-hand side
/// z, as decompose() does; false if one is not accepted.
template <int k, bool kDefinite, typename F, int P, int N>
[[gnu::always_inline]] inline bool eliminate_two(F (&a)[P][P], F (&l)[P][N], F (&inverse)[P],
                                                 F (&z)[P]) {
  const F x = a[k][k], inverse_x = F(1) / x;
  inverse[k] = inverse_x;
  bool accepted = !kDefinite || x > F(0);
  if constexpr (k + 1 == P) {
    z[k] *= inverse_x;
    return accepted & (inverse_x - inverse_x == F(0));
  } else {
    const F c = a[k][k + 1], of_pair = F(1) / determinant(x, c, a[k + 1][k + 1]);
    const F other = x * of_pair;
    inverse[k + 1] = other;
    accepted &= (of_pair - of_pair == F(0)) & (kDefinite ? of_pair > F(0) : other != F(0));
    const F l_pair = c * inverse_x;
    l[k][k + 1] = l_pair;
    F p[P], q[P], l_p[P], l_q[P];
    unrolled<k + 2, P>([&](auto i) __attribute__((always_inline)) {
      p[i] = a[k][i];
      q[i] = a[k + 1][i] - p[i] * l_pair;
      l[k][i] = l_p[i] = p[i] * inverse_x;
    });
    constexpr int kNext = k + 4 < P ? k + 4 : P;
    unrolled<k + 2, kNext>([&](auto j) __attribute__((always_inline)) {  // which are waited for
      constexpr int kColumn = j;
      unrolled<kColumn, kNext>([&](auto i) __attribute__((always_inline)) {
        a[kColumn][i] = (a[kColumn][i] - p[i] * l_p[kColumn]) - q[kColumn] * q[i] * other;
      });
    });
    unrolled<k + 2, P>([&](auto j) __attribute__((always_inline)) {
      constexpr int kColumn = j;
      l[k + 1][kColumn] = l_q[kColumn] = q[kColumn] * other;
      unrolled<(kColumn > kNext ? kColumn : kNext), P>([&](auto i) __attribute__((always_inline)) {
        a[kColumn][i] = (a[kColumn][i] - p[i] * l_p[kColumn]) - q[i] * l_q[kColumn];
      });
    });
    const F z_k = z[k], z_other = z[k + 1] - l_pair * z_k;
    unrolled<k + 2, P>([&](auto i) __attribute__((always_inline)) {
      z[i] = (z[i] - l_p[i] * z_k) - l_q[i] * z_other;
    });
    z[k] = z_k * inverse_x;
    z[k + 1] = z_other * other;
    return accepted;
  }
}

/// L D Lᵀ of columns that lie `stride` apart: L below its diagonal, column by column, D⁻¹ and z =
/// D⁻¹ L⁻¹ y; false if a pivot is not accepted.
template <bool kDefinite, typename F, int P, int N>
[[gnu::always_inline]] inline bool eliminate_triangle(const F* columns, int stride, const F* y,
                                                      F (&l)[P][N], F (&inverse)[P], F (&z)[P]) {
  F a[P][P];
  unrolled<0, P>([&](auto j) __attribute__((always_inline)) {
    constexpr int kColumn = j;
    unrolled<kColumn, P>([&](auto i) __attribute__((always_inline)) {
      a[kColumn][i] = columns[kColumn * stride + i];
    });
    z[j] = y[j];
  });
  bool accepted = true;
  unrolled<0, (P + 1) / 2>([&](auto pair) __attribute__((always_inline)) {
    accepted &= eliminate_two<2 * pair, kDefinite>(a, l, inverse, z);
  });
  return accepted;
}

/// M = L⁻¹ by columns of N numbers, and by rows. What is not below the diagonal stays.
template <int N, typename F, int P, int Q>
[[gnu::always_inline]] inline void store_inverse(const F (&l)[P][Q], F* columns, F* rows) {
  unrolled<0, P>([&](auto j) __attribute__((always_inline)) {
    constexpr int kColumn = j;
    F m[P];
    unrolled<kColumn + 1, P>([&](auto i) __attribute__((always_inline)) {
      constexpr int kRow = i;
      F sum = -l[kColumn][kRow];
      unrolled<kColumn + 1, kRow>(
          [&](auto k) __attribute__((always_inline)) { sum -= l[k][kRow] * m[k]; });
      m[kRow] = sum;
      columns[kColumn * N + kRow] = sum;
      rows[kRow * N + kColumn] = sum;
    });
  });
}

/// The diagonals that store_inverse() leaves as they are.
template <typename F>
void store_ones(int pivots, int lanes, F* columns, F* rows) {
  for (int j = 0; j < pivots; ++j) columns[j * (lanes + 1)] = rows[j * (lanes + 1)] = F(1);
}

/// z becomes L⁻ᵀ z.
template <typename F, int P, int N>
[[gnu::always_inline]] inline void substitute_back(const F (&l)[P][N], F (&z)[P]) {
  unrolled<1, P>([&](auto last) __attribute__((always_inline)) {
    constexpr int kRow = P - last;
    unrolled<0, kRow>(
        [&](auto j) __attribute__((always_inline)) { z[j] -= l[j][kRow] * z[kRow]; });
  });
}

}  // namespace mbs::compiled_ldl
