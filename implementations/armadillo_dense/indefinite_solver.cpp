// Dense factorization of a symmetric indefinite matrix, in place, by LAPACK.
#include "indefinite_solver.hpp"

#include <algorithm>
#include <cmath>

// Armadillo declares neither. The trailing argument is the length of the character argument.
extern "C" void arma_fortran(dsytrf)(const char* uplo, const arma::blas_int* n, double* A,
                                     const arma::blas_int* ldA, arma::blas_int* ipiv, double* work,
                                     const arma::blas_int* lwork, arma::blas_int* info,
                                     arma::blas_len);
extern "C" void arma_fortran(dsytrs)(const char* uplo, const arma::blas_int* n,
                                     const arma::blas_int* nrhs, const double* A,
                                     const arma::blas_int* ldA, const arma::blas_int* ipiv,
                                     double* b, const arma::blas_int* ldb, arma::blas_int* info,
                                     arma::blas_len);

namespace mbs::armadillo_dense {

using arma::blas_int;

namespace {

// The columns of workspace set how many columns dsytrf takes as one block. The 64 that it asks for
// leave most of the work of matrices this small to dgemv instead of dgemm.
constexpr arma::uword kBlockColumns = 24;

}  // namespace

IndefiniteSolver::IndefiniteSolver(int size)
    : A_(size, size, arma::fill::zeros),
      pivots_(static_cast<std::size_t>(size)),
      workspace_(kBlockColumns * static_cast<arma::uword>(std::max(size, 1))) {}

bool IndefiniteSolver::factorize() {
  const auto n = static_cast<blas_int>(A_.n_rows);
  const blas_int ld = std::max(n, 1);
  const auto length = static_cast<blas_int>(workspace_.n_elem);
  blas_int info = 0;
  arma_fortran(dsytrf)("L", &n, A_.memptr(), &ld, pivots_.data(), workspace_.memptr(), &length,
                       &info, 1);
  // Not every LAPACK reports a NaN, but wherever one is in A, it reaches D, which is on the
  // diagonal and, where blocks are 2 x 2, beside it.
  bool finite = true;
  for (arma::uword i = 0; i < A_.n_rows; ++i) {
    finite &= std::isfinite(A_.at(i, i));
    if (pivots_[i] < 0 && i + 1 < A_.n_rows) finite &= std::isfinite(A_.at(i + 1, i));
  }
  return info == 0 && finite;
}

void IndefiniteSolver::solve(arma::vec& b) const {
  const auto n = static_cast<blas_int>(A_.n_rows);
  const blas_int ld = std::max(n, 1);
  const blas_int columns = 1;
  blas_int info = 0;
  arma_fortran(dsytrs)("L", &n, &columns, A_.memptr(), &ld, pivots_.data(), b.memptr(), &ld, &info,
                       1);
}

}  // namespace mbs::armadillo_dense
