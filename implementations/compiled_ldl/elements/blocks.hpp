// Additions to blocks of the matrix, D rows and columns at a time, at places known beforehand.
#pragma once

#include "program.hpp"
#include "scalar.hpp"

namespace mbs::compiled_ldl {

/// Where a block lies: its first entry and the distance of its columns.
struct Place {
  int at = 0;
  int stride = 0;
};

inline Place place_of(const Program& program, int row, int column) {
  return {program.entry(row, column), program.fronts[program.front_of_row[column]].stride};
}

template <int D, typename S>
S dot(const S* a, const S* b) {
  S sum = a[0] * b[0];
  for (int i = 1; i < D; ++i) sum += a[i] * b[i];
  return sum;
}

/// += s g gᵀ, lower triangle.
template <int D, typename F, typename S>
void add_square(F* matrix, const Place& place, const S& s, const S* g) {
  for (int j = 0; j < D; ++j) {
    const S t = s * g[j];
    F* column = matrix + place.at + j * place.stride;
    for (int i = j; i < D; ++i) column[i] += static_cast<F>(t * g[i]);
  }
}

/// += s y xᵀ, rows y, columns x.
template <int D, typename F, typename S>
void add_outer(F* matrix, const Place& place, const S& s, const S* y, const S* x) {
  for (int j = 0; j < D; ++j) {
    const S t = s * x[j];
    F* column = matrix + place.at + j * place.stride;
    for (int i = 0; i < D; ++i) column[i] += static_cast<F>(t * y[i]);
  }
}

/// += p I.
template <int D, typename F, typename S>
void add_identity(F* matrix, const Place& place, const S& p) {
  for (int j = 0; j < D; ++j) matrix[place.at + j * (place.stride + 1)] += static_cast<F>(p);
}

/// Two points, the free one first, or of two free ones that which is eliminated first.
struct Pair {
  int a = 0, b = 0;  ///< rows of their first coordinates
  Place aa = {}, bb = {}, ba = {};
};

/// += sum, rows and columns of one block; `lower`: its lower triangle.
template <int D, bool lower, typename F, typename S>
void add_block(F* matrix, const Place& place, const S (&sum)[D][D]) {
  for (int j = 0; j < D; ++j) {
    F* column = matrix + place.at + j * place.stride;
    for (int i = lower ? j : 0; i < D; ++i) column[i] += static_cast<F>(sum[j][i]);
  }
}

/// += s g gᵀ + p I (p: none or one number) at (a, a) and (b, b), its negative between them; `free`:
/// how many points are. No entry is taken up twice.
template <int D, typename F, typename S, typename... P>
void add_pair(F* matrix, const Pair& pair, int free, const S& s, const S* g, const P&... p) {
  if (free == 0) return;
  S sum[D][D];
  for (int j = 0; j < D; ++j) {
    for (int i = 0; i < D; ++i) sum[j][i] = s * g[j] * g[i];
    ((sum[j][j] += p), ...);
  }
  add_block<D, true>(matrix, pair.aa, sum);
  if (free == 1) return;
  add_block<D, true>(matrix, pair.bb, sum);
  for (auto& column : sum) {
    for (S& entry : column) entry = -entry;
  }
  add_block<D, false>(matrix, pair.ba, sum);
}
/// += p I likewise, without g.
template <int D, typename F, typename S>
void add_pair_identity(F* matrix, const Pair& pair, int free, const S& p) {
  if (free == 0) return;
  add_identity<D>(matrix, pair.aa, p);
  if (free == 1) return;
  add_identity<D>(matrix, pair.bb, p);
  add_identity<D>(matrix, pair.ba, -p);
}

/// Pairs in the order of the program: first those of two free points, then of one, then of none.
/// Rods A - B, B - C and C - D with A and D fixed, B on rows 0-1 and C on rows 2-3, A and D behind
/// all rows, from 16 and 18 on: the list is (0, 2), (0, 16), (2, 18); two = 1, one = 3.
struct Pairs {
  std::vector<Pair> list;
  int two = 0, one = 0;  ///< how many have two free points; two or one

  [[nodiscard]] int count() const { return static_cast<int>(list.size()); }
  [[nodiscard]] int free(int k) const { return k < two ? 2 : k < one ? 1 : 0; }
};

/// Up to four points a, b, c, d and two vectors: A at a, −A at b, C at c, −C at d. The distinct
/// free ones among them, in the order of elimination, have σ_A A + σ_C C.
/// A planar angle at B, a = A, c = C and b = d = B, with A, C and B on rows 0, 2 and 4: points =
/// {0, 1, 0}, {2, 0, 1}, {4, −1, −1}; its places are those of the blocks (0, 0), (2, 0), (4, 0),
/// (2, 2), (4, 2), (4, 4).
struct Quad {
  struct Point {
    int row = 0;
    double sign_a = 0.0, sign_c = 0.0;
  };
  int a = 0, b = 0, c = 0, d = 0;  ///< rows
  int free = 0;
  Point points[4] = {};
  int places = 0;  ///< where the blocks (j, i), j >= i, of these points begin in a list of places
};

/// g: the gradient at each of the quad's free points, for vectors A and C.
template <int D, typename S>
void find_gradients(const Quad& quad, const S* vector_a, const S* vector_c, S* g) {
  for (int i = 0; i < quad.free; ++i) {
    const S sign_a = quad.points[i].sign_a, sign_c = quad.points[i].sign_c;
    for (int x = 0; x < D; ++x) g[i * D + x] = sign_a * vector_a[x] + sign_c * vector_c[x];
  }
}

/// += s g gᵀ.
template <int D, typename F, typename S>
void add_quad(F* matrix, const Quad& quad, const Place* places, const S& s, const S* g) {
  const Place* place = places + quad.places;
  for (int i = 0; i < quad.free; ++i) {
    add_square<D>(matrix, *place++, s, g + i * D);
    for (int j = i + 1; j < quad.free; ++j) {
      add_outer<D>(matrix, *place++, s, g + j * D, g + i * D);
    }
  }
}

}  // namespace mbs::compiled_ldl
