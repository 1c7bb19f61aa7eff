// Small scenes: all rows of the matrix in a few vector registers; differences of points as rows.
#pragma once

#include <algorithm>

#include "mbs/model.hpp"
#include "panels/vectors.hpp"
#include "scalar.hpp"

namespace mbs::compiled_ldl {

/// N numbers, one a coordinate of q, in its order; padded with zeros. Six in vectors of four:
/// kVectors = 2, kSize = 8, v = {q0 q1 q2 q3}, {q4 q5 0 0}.
template <int N>
struct SmallRow {
  static constexpr int kLanes = std::min(lanes_for(N), kRegisterDoubles);
  static constexpr int kVectors = (N + kLanes - 1) / kLanes;
  static constexpr int kSize = kLanes * kVectors;
  using V = typename Short<double, kLanes>::Type;
  V v[kVectors];

  static SmallRow zero() {
    SmallRow row;
    for (int r = 0; r < kVectors; ++r) row.v[r] = V{};
    return row;
  }
  static SmallRow of(const double* x) {
    SmallRow row;
    for (int r = 0; r < kVectors; ++r) row.v[r] = load<double, kLanes>(x + r * kLanes);
    return row;
  }
  void put(double* x) const {
    for (int r = 0; r < kVectors; ++r) store<double, kLanes>(x + r * kLanes, v[r]);
  }
  /// += s x.
  void add(double s, const double* x) {
    for (int r = 0; r < kVectors; ++r) v[r] += s * load<double, kLanes>(x + r * kLanes);
  }
  void add(double s, const SmallRow& x) {
    for (int r = 0; r < kVectors; ++r) v[r] += s * x.v[r];
  }
  /// Whether every |x| <= bound; a NaN is not.
  [[nodiscard]] bool is_within(double bound) const {
    auto beyond = (v[0] < 0.0 ? -v[0] : v[0]) <= bound;
    for (int r = 1; r < kVectors; ++r) beyond &= (v[r] < 0.0 ? -v[r] : v[r]) <= bound;
    long long all = -1;
    for (int i = 0; i < kLanes; ++i) all &= beyond[i];
    return all != 0;
  }
};

/// Columns of a symmetric matrix, of which the lower halves count: [4 1; 1 3] is column = {4 1},
/// {· 3}, whatever the · is.
template <int N>
struct SmallMatrix {
  using Row = SmallRow<N>;
  Row column[N];

  static SmallMatrix of(const double* x) {
    SmallMatrix matrix;
#pragma GCC unroll 16
    for (int j = 0; j < N; ++j) matrix.column[j] = Row::of(x + j * Row::kSize);
    return matrix;
  }
  void put(double* x) const {
#pragma GCC unroll 16
    for (int j = 0; j < N; ++j) column[j].put(x + j * Row::kSize);
  }
  /// += s g gᵀ.
  [[gnu::always_inline]] void add_square(double s, const double* g) {
    Row scaled = Row::zero();
    scaled.add(s, g);
#pragma GCC unroll 16
    for (int j = 0; j < N; ++j) {
      for (int r = j / Row::kLanes; r < Row::kVectors; ++r) column[j].v[r] += scaled.v[r] * g[j];
    }
  }
};

/// Whether the matrix stays in registers while elements are added to it.
template <int N>
inline constexpr bool kInRegisters = N* SmallRow<N>::kVectors <= 8;

/// u = r_a − r_b of two points, and ∂u/∂q. Of two free points of a plane that are all there is, N =
/// 4: a = 0, b = 2, rows = {1 0 −1 0}, {0 1 0 −1}; u = (3, 4) has the distance's row of Φq {6 8 −6
/// −8}.
template <int N, int D>
struct Difference {
  using Row = SmallRow<N>;
  int a = 0, b = 0;  // where vectors of coordinates have them
  alignas(64) double rows[D][Row::kSize] = {};

  /// Fixed points lie behind the rows.
  Difference() = default;
  Difference(const Model& model, int point_a, int point_b)
      : a(place(model, point_a)), b(place(model, point_b)) {
    for (int x = 0; x < D; ++x) {
      if (a < N) rows[x][a + x] += 1.0;
      if (b < N) rows[x][b + x] -= 1.0;
    }
  }
  static int place(const Model& model, int point) {
    if (point < 0) return 0;
    if (!model.points()[point].is_fixed()) return model.points()[point].offset;
    return Row::kSize + point * D;
  }
  static int extent(const Model& model) {
    return Row::kSize + D * static_cast<int>(model.points().size());
  }
  void of(const double* q, double* u) const {
    for (int x = 0; x < D; ++x) u[x] = q[a + x] - q[b + x];
  }
  /// row += (∂u/∂q)ᵀ f.
  void add_transposed(const double* f, Row& row) const {
    for (int x = 0; x < D; ++x) row.add(f[x], rows[x]);
  }
  /// matrix += Σ_x t_x ∂u_x/∂q: in registers to all columns, else to those of the two points.
  [[gnu::always_inline]] void add_outer(const Row (&t)[D], SmallMatrix<N>& matrix) const {
    if constexpr (kInRegisters<N>) {
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j) {
        for (int x = 0; x < D; ++x) matrix.column[j].add(rows[x][j], t[x]);
      }
    } else {
      for (int x = 0; x < D; ++x) {
        if (a < N) matrix.column[a + x].add(1.0, t[x]);
        if (b < N) matrix.column[b + x].add(-1.0, t[x]);
      }
    }
  }
  /// matrix += g ((∂u/∂q)ᵀ f)ᵀ, likewise.
  [[gnu::always_inline]] void add_columns(const Row& g, const double* f,
                                          SmallMatrix<N>& matrix) const {
    if constexpr (kInRegisters<N>) {
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j) {
        for (int x = 0; x < D; ++x) matrix.column[j].add(rows[x][j] * f[x], g);
      }
    } else {
      for (int x = 0; x < D; ++x) {
        if (a < N) matrix.column[a + x].add(f[x], g);
        if (b < N) matrix.column[b + x].add(-f[x], g);
      }
    }
  }
};

}  // namespace mbs::compiled_ldl
