// Symmetric matrices in panel-major storage of their lower half: Cholesky, solves, products.
#pragma once

#include "vectors.hpp"

namespace mbs::hybrid_dense {

/// Panel p holds the kWidth rows from p kWidth on, columns 0 to the diagonal block's last, one
/// column after the other. So a kernel reads whole vectors, and panels lie one behind the other.
/// Rows and columns beyond n fill the last panel.
struct Panels {
  explicit Panels(long n) : count(padded(n) / kWidth) {}

  [[nodiscard]] static long start(long panel) {
    return kWidth * kWidth * (panel * (panel + 1) / 2);
  }
  [[nodiscard]] long size() const { return start(count); }
  /// Of entry (i, j), i >= j.
  [[nodiscard]] static long position(long i, long j) {
    return start(i / kWidth) + j * kWidth + i % kWidth;
  }

  long count;
};

/// A = Z Z^T; false unless A is positive definite. Z has the inverses of its diagonal blocks in
/// their places.
[[nodiscard]] bool factorize(const Panels& panels, const double* A, double* Z);

/// A x = b with Z of factorize(); x, padded to whole vectors by zeros, is b when it arrives.
void solve(const Panels& panels, const double* Z, double* x);

/// y = A x, A symmetric. Both are padded by zeros; A's padding is not read for anything that
/// counts.
void multiply(const Panels& panels, const double* A, const double* x, double* y);

}  // namespace mbs::hybrid_dense
