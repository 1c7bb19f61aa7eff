#include "panels.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::hybrid_dense {
namespace {

constexpr int W = kWidth;

// What rows below a diagonal block are divided by: the block is U D U^T, U unit lower triangular.
// Without roots in the chain of pivots, that chain is half as long.
struct Block {
  double U[W][W];   // U[row][column]
  double scale[W];  // 1 / sqrt(d)
};

// acc[g] -= (rows of panel g) (rows of the panel `across`)^T over `depth` columns.
template <int G>
[[gnu::always_inline]] inline void update(Vec (&acc)[G][W], const double* const (&rows)[G],
                                          const double* across, long depth) {
  for (long j = 0; j < depth; ++j) {
    Vec a[G];
    for (int g = 0; g < G; ++g) a[g] = load(rows[g] + j * W);
    for (int t = 0; t < W; ++t) {
      const Vec b = broadcast(across[j * W + t]);
      for (int g = 0; g < G; ++g) acc[g][t] -= a[g] * b;
    }
  }
}

// Factorizes a diagonal block; stores the inverse of U sqrt(D). False unless all pivots are
// positive.
[[gnu::always_inline]] inline bool factorize_block(const Vec (&acc)[W], Block& block,
                                                   double* inverse) {
  double a[W][W];  // a[column][row]
  for (int t = 0; t < W; ++t) {
    for (int r = t; r < W; ++r) a[t][r] = acc[t][r];
  }
  bool positive = true;
#pragma GCC unroll 8
  for (int t = 0; t < W; ++t) {
    positive &= a[t][t] > 0.0;  // NaN fails
    const double reciprocal = 1.0 / a[t][t];
#pragma GCC unroll 8
    for (int s = t + 1; s < W; ++s) {
      block.U[s][t] = a[t][s] * reciprocal;
#pragma GCC unroll 8
      for (int r = s; r < W; ++r) a[s][r] -= block.U[s][t] * a[t][r];
    }
    block.scale[t] = std::sqrt(reciprocal);
  }
  // Column t of the inverse of U, each row scaled.
#pragma GCC unroll 8
  for (int t = 0; t < W; ++t) {
    double x[W] = {};
    x[t] = 1.0;
#pragma GCC unroll 8
    for (int r = t + 1; r < W; ++r) {
#pragma GCC unroll 8
      for (int s = t; s < r; ++s) x[r] -= block.U[r][s] * x[s];
    }
    for (int r = 0; r < W; ++r) inverse[t * W + r] = r < t ? 0.0 : x[r] * block.scale[r];
  }
  return positive;
}

// Rows of Z below a diagonal block, from acc: acc U^-T D^-1/2.
template <int G>
[[gnu::always_inline]] inline void divide(Vec (&acc)[G][W], int first, const Block& block,
                                          double* const (&out)[G]) {
  for (int t = 0; t < W; ++t) {
    for (int s = 0; s < t; ++s) {
      const Vec u = broadcast(block.U[t][s]);
      for (int g = first; g < G; ++g) acc[g][t] -= acc[g][s] * u;
    }
  }
  for (int t = 0; t < W; ++t) {
    const Vec scale = broadcast(block.scale[t]);
    for (int g = first; g < G; ++g) store(out[g] + t * W, acc[g][t] * scale);
  }
}

// Block column c in the panels row ... row + G - 1; with the diagonal block if row = c.
template <int G, bool kDiagonal>
[[gnu::always_inline]] inline bool finish(long c, long row, const double* A, double* Z,
                                          Block& block) {
  Vec acc[G][W];
  const double* rows[G];
  double* out[G];
  const double* across = Z + Panels::start(c);
  const long depth = c * W;
  for (int g = 0; g < G; ++g) {
    const long start = Panels::start(row + g);
    rows[g] = Z + start;
    out[g] = Z + start + depth * W;
    for (int t = 0; t < W; ++t) acc[g][t] = load(A + start + (depth + t) * W);
  }
  update<G>(acc, rows, across, depth);
  bool positive = true;
  if constexpr (kDiagonal) positive = factorize_block(acc[0], block, out[0]);
  divide<G>(acc, kDiagonal ? 1 : 0, block, out);
  return positive;
}

// Panels at once where `left` are left: three W accumulators and four vectors fill the registers.
long step(long left) { return std::min(left, 3L); }

template <bool kDiagonal>
[[gnu::always_inline]] inline bool finish(long c, long row, long left, const double* A, double* Z,
                                          Block& block) {
  switch (step(left)) {
    case 1:
      return finish<1, kDiagonal>(c, row, A, Z, block);
    case 2:
      return finish<2, kDiagonal>(c, row, A, Z, block);
    default:
      return finish<3, kDiagonal>(c, row, A, Z, block);
  }
}

}  // namespace

bool factorize(const Panels& panels, const double* A, double* Z) {
  bool positive = true;
  for (long c = 0; c < panels.count; ++c) {
    Block block;
    positive &= finish<true>(c, c, panels.count - c, A, Z, block);
    for (long row = c; (row += step(panels.count - row)) < panels.count;) {
      finish<false>(c, row, panels.count - row, A, Z, block);
    }
  }
  return positive;
}

void solve(const Panels& panels, const double* Z, double* x) {
  for (long p = 0; p < panels.count; ++p) {  // Z y = b
    const double* panel = Z + Panels::start(p);
    Vec acc[W] = {load(x + p * W)};
    for (long j = 0; j < p * W; j += W) {
      for (int t = 0; t < W; ++t) acc[t] -= load(panel + (j + t) * W) * broadcast(x[j + t]);
    }
    Vec rest = acc[0];
    for (int t = 1; t < W; ++t) rest += acc[t];
    panel += p * W * W;
    Vec y = load(panel) * broadcast(rest[0]);
    for (int t = 1; t < W; ++t) y += load(panel + t * W) * broadcast(rest[t]);
    store(x + p * W, y);
  }
  for (long p = panels.count - 1; p >= 0; --p) {  // Z^T x = y
    Vec acc[W] = {};
    // The newest part of x comes last.
    for (long r = panels.count - 1; r > p; --r) {
      const double* block = Z + Panels::start(r) + p * W * W;
      const Vec x_r = load(x + r * W);
      for (int t = 0; t < W; ++t) acc[t] += load(block + t * W) * x_r;
    }
    const Vec rest = load(x + p * W) - sums(acc);
    const double* inverse = Z + Panels::start(p) + p * W * W;
    for (int t = 0; t < W; ++t) acc[t] = load(inverse + t * W) * rest;
    store(x + p * W, sums(acc));
  }
}

void multiply(const Panels& panels, const double* A, const double* x, double* y) {
  for (long p = 0; p < panels.count; ++p) {
    const double* panel = A + Panels::start(p);
    const Vec x_p = load(x + p * W);
    Vec acc[W] = {};
    for (long j = 0; j < p * W; j += W) {
      Vec down[W];
      for (int t = 0; t < W; ++t) {
        const Vec column = load(panel + (j + t) * W);
        acc[t] += column * broadcast(x[j + t]);
        down[t] = column * x_p;
      }
      store(y + j, load(y + j) + sums(down));
    }
    panel += p * W * W;  // the diagonal block, of which both halves are there
    Vec sum = load(panel) * broadcast(x[p * W]);
    for (int t = 1; t < W; ++t) sum += load(panel + t * W) * broadcast(x[p * W + t]);
    for (int t = 0; t < W; ++t) sum += acc[t];
    store(y + p * W, sum);
  }
}

}  // namespace mbs::hybrid_dense
