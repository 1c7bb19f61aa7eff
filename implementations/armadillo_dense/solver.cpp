// Dense Cholesky factorization of the tangent matrix, in place, by LAPACK and BLAS.
#include "solver.hpp"

#include <algorithm>
#include <limits>

// Armadillo declares no dtrsv. The trailing arguments are the lengths of the character arguments.
extern "C" void arma_fortran(dtrsv)(const char* uplo, const char* trans, const char* diag,
                                    const arma::blas_int* n, const double* A,
                                    const arma::blas_int* ldA, double* x,
                                    const arma::blas_int* incx, arma::blas_len, arma::blas_len,
                                    arma::blas_len);

namespace mbs::armadillo_dense {

using arma::blas_int;

bool CholeskySolver::factorize() {
  auto n = static_cast<blas_int>(T_.n_rows);
  blas_int ld = std::max(n, 1);
  char uplo = 'L';
  blas_int info = 0;
  arma::lapack::potrf(&uplo, &n, T_.memptr(), &ld, &info);
  // Not every LAPACK reports a NaN, but wherever one is in T, it reaches the diagonal of L.
  bool finite = true;
  for (arma::uword i = 0; i < T_.n_rows; ++i) {
    finite &= T_.at(i, i) <= std::numeric_limits<double>::max();
  }
  return info == 0 && finite;
}

void CholeskySolver::solve(arma::vec& b) const {
  const auto n = static_cast<blas_int>(T_.n_rows);
  const blas_int ld = std::max(n, 1);
  const blas_int stride = 1;
  if (solves_ == Solves::potrs) {
    char uplo = 'L';
    blas_int size = n, height = ld, info = 0;
    auto* L = const_cast<double*>(T_.memptr());  // which it only reads
    arma::lapack::potrs(&uplo, &size, &stride, L, &height, b.memptr(), &height, &info);
    return;
  }
  arma_fortran(dtrsv)("L", "N", "N", &n, T_.memptr(), &ld, b.memptr(), &stride, 1, 1, 1);
  arma_fortran(dtrsv)("L", "T", "N", &n, T_.memptr(), &ld, b.memptr(), &stride, 1, 1, 1);
}

}  // namespace mbs::armadillo_dense
