// Calls DGETRF and DGETRS, the two halves of DGESV, of whatever LAPACK the generic name stands for.
#include "solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

extern "C" {
void dgetrf_(const int* m, const int* n, double* a, const int* lda, int* ipiv, int* info);
void dgetrs_(const char* trans, const int* n, const int* nrhs, const double* a, const int* lda,
             const int* ipiv, double* b, const int* ldb, int* info, std::size_t trans_length);
void ilaver_(int* major, int* minor, int* patch);
}

namespace mbs::starting_dense {

bool Solver::factorize() {
  const int n = matrix_.rows();
  // |T_ij| <= max(T_ii, T_jj): a finite diagonal means a finite T. Not every BLAS finds a pivot
  // among NaNs, so that none may get there.
  for (int i = 0; i < n; ++i) {
    if (!std::isfinite(matrix_(i, i))) return false;
  }
  const int stride = std::max(1, n);
  int info = 0;
  dgetrf_(&n, &n, matrix_.data(), &stride, pivots_.data(), &info);
  return info == 0;
}

void Solver::solve(Vector& x) const {
  const int n = matrix_.rows();
  const int stride = std::max(1, n);
  const int one = 1;
  int info = 0;
  dgetrs_("N", &n, &one, matrix_.data(), &stride, pivots_.data(), x.data(), &stride, &info, 1);
}

std::string Solver::version() {
  int major = 0, minor = 0, patch = 0;
  ilaver_(&major, &minor, &patch);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

}  // namespace mbs::starting_dense
