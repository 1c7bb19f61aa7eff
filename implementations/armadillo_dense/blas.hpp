// Products of matrices and vectors by BLAS, over the memory of Armadillo's matrices.
#pragma once

#include <algorithm>
#include <armadillo>

// Armadillo declares no dsymv. The trailing argument is the length of the character argument.
extern "C" void arma_fortran(dsymv)(const char* uplo, const arma::blas_int* n, const double* alpha,
                                    const double* A, const arma::blas_int* ldA, const double* x,
                                    const arma::blas_int* incx, const double* beta, double* y,
                                    const arma::blas_int* incy, arma::blas_len);

namespace mbs::armadillo_dense {

inline constexpr double kOne = 1.0;
inline constexpr arma::blas_int kStride = 1;

/// y += factor M x, with the lower triangle of M.
inline void add_symmetric_product(double factor, const arma::mat& M, const double* x, double* y) {
  const auto n = static_cast<arma::blas_int>(M.n_rows);
  const arma::blas_int ld = std::max(n, 1);
  arma_fortran(dsymv)("L", &n, &factor, M.memptr(), &ld, x, &kStride, &kOne, y, &kStride, 1);
}

/// y += factor A x, A: rows x columns, each `height` apart. Costs nothing without columns.
inline void add_product(double factor, const double* A, arma::blas_int height, arma::blas_int rows,
                        arma::blas_int columns, const double* x, double* y) {
  if (columns == 0) return;
  const arma::blas_int ld = std::max(height, 1);
  arma::blas::gemv("N", &rows, &columns, &factor, A, &ld, x, &kStride, &kOne, y, &kStride);
}

/// Lower triangle of C += factor A Aᵀ, A likewise. Costs nothing without columns.
inline void add_outer_product(double factor, const double* A, arma::blas_int height,
                              arma::blas_int columns, arma::mat& C) {
  if (columns == 0) return;
  const auto rows = static_cast<arma::blas_int>(C.n_rows);
  const arma::blas_int ldA = std::max(height, 1);
  const arma::blas_int ldC = std::max(rows, 1);
  arma::blas::syrk("L", "N", &rows, &columns, &factor, A, &ldA, &kOne, C.memptr(), &ldC);
}

}  // namespace mbs::armadillo_dense
