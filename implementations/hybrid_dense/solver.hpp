// Dense Cholesky factorizations and solves. All three keep the assembled matrix and factorize a
// copy, so that entries which never change are written once.
#pragma once

#include <algorithm>
#include <string>

#include "panels.hpp"

namespace mbs::hybrid_dense {

/// Of Eigen and of the LAPACK that is loaded.
std::string library_versions();

/// Own kernels, in panels.
class PanelsSolver {
 public:
  static constexpr bool kProducts = false;  // whether it has multiply()
  explicit PanelsSolver(long n) : panels_(n), A_(panels_.size()), Z_(panels_.size()) {
    for (long i = n; i < padded(n); ++i) A_[Panels::position(i, i)] = 1.0;
  }
  /// The lower half is to be written; kWidth rows from a multiple of kWidth on lie one behind the
  /// other.
  double* matrix() { return A_.data(); }
  static long position(long i, long j) { return Panels::position(i, j); }
  /// False unless the matrix is positive definite.
  [[nodiscard]] bool factorize() { return hybrid_dense::factorize(panels_, A_.data(), Z_.data()); }
  /// x is the right-hand side when it arrives; padded by zeros.
  void solve(double* x) const { hybrid_dense::solve(panels_, Z_.data(), x); }
  /// `count` of them, each `stride` behind the one before.
  void solve(double* x, long count, long stride) const {
    for (long k = 0; k < count; ++k) solve(x + k * stride);
  }

 private:
  Panels panels_;
  Array A_, Z_;
};

/// Columns one behind the other, as libraries take them.
class ColumnsSolver {
 public:
  static constexpr bool kProducts = true;
  explicit ColumnsSolver(long n)
      : n_(n), rows_(std::max<long>(padded(n), kWidth)), A_(n * rows_), L_(n * rows_) {}
  double* matrix() { return A_.data(); }
  [[nodiscard]] long position(long i, long j) const { return j * rows_ + i; }

 protected:
  // Neither Eigen nor every LAPACK stops at a pivot that is a NaN, but all later ones are NaN then.
  [[nodiscard]] bool is_positive() const { return n_ == 0 || L_[position(n_ - 1, n_ - 1)] > 0.0; }
  // The upper half is never read.
  void copy() {
    for (long j = 0; j < n_; ++j) {
      std::copy(A_.data() + j * rows_ + j, A_.data() + j * rows_ + n_, L_.data() + j * rows_ + j);
    }
  }

  const long n_, rows_;
  Array A_, L_;
};

/// Eigen's kernels, blocks of our own.
class LltSolver : public ColumnsSolver {
 public:
  using ColumnsSolver::ColumnsSolver;
  [[nodiscard]] bool factorize();
  /// x = L^-1 x for `count` vectors, each `stride` behind the one before; then their products with
  /// each other into the lower half of the matrix of `products`.
  void multiply(double* x, long count, long stride, LltSolver& products) const;
  void solve_lower(double* x) const;  // x = L^-1 x
  void solve_upper(double* x) const;  // x = L^-T x
  void solve(double* x) const {
    solve_lower(x);
    solve_upper(x);
  }
  void solve(double* x, long count, long stride) const;
};

/// Eigen's blocks.
class LltBlocksSolver : public LltSolver {
 public:
  using LltSolver::LltSolver;
  [[nodiscard]] bool factorize();
};

/// LAPACK's dpotrf and dpotrs.
class PotrfSolver : public ColumnsSolver {
 public:
  using ColumnsSolver::ColumnsSolver;
  [[nodiscard]] bool factorize();
  void multiply(double* x, long count, long stride, PotrfSolver& products) const;
  void solve_lower(double* x) const;
  void solve_upper(double* x) const;
  void solve(double* x) const { solve(x, 1, rows_); }
  void solve(double* x, long count, long stride) const;
};

}  // namespace mbs::hybrid_dense
