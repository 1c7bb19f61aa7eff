#include "solver.hpp"

#include <Eigen/Cholesky>

extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dpotrs_(const char* uplo, const int* n, const int* nrhs, const double* a, const int* lda,
             double* b, const int* ldb, int* info);
}

namespace mbs::hybrid_dense {
namespace {

constexpr int kAlignment = kWidth * sizeof(double);
template <class Matrix>
using Columns = Eigen::Map<Matrix, kAlignment, Eigen::OuterStride<>>;

// Up to here Eigen's unblocked factorization is the fastest, then blocks of kBlock; measured.
constexpr long kUnblocked = 32, kBlock = 16;

}  // namespace

bool LltSolver::factorize() {
  copy();
  Columns<Eigen::MatrixXd> L(L_.data(), n_, n_, Eigen::OuterStride<>(rows_));
  using Factorization = Eigen::internal::llt_inplace<double, Eigen::Lower>;
  if (n_ <= kUnblocked) return Factorization::unblocked(L) < 0;
  for (long k = 0; k < n_; k += kBlock) {
    const long size = std::min(kBlock, n_ - k), rest = n_ - k - size;
    auto diagonal = L.block(k, k, size, size);
    auto below = L.block(k + size, k, rest, size);
    if (Factorization::unblocked(diagonal) >= 0) return false;
    if (rest == 0) break;
    diagonal.triangularView<Eigen::Lower>().adjoint().solveInPlace<Eigen::OnTheRight>(below);
    L.block(k + size, k + size, rest, rest)
        .selfadjointView<Eigen::Lower>()
        .rankUpdate(below, -1.0);
  }
  return true;
}

void LltSolver::solve(double* x) const {
  const Columns<const Eigen::MatrixXd> L(L_.data(), n_, n_, Eigen::OuterStride<>(rows_));
  Eigen::Map<Eigen::VectorXd, kAlignment> solution(x, n_);
  L.triangularView<Eigen::Lower>().solveInPlace(solution);
  L.triangularView<Eigen::Lower>().adjoint().solveInPlace(solution);
}

bool PotrfSolver::factorize() {
  copy();
  const int n = static_cast<int>(n_), rows = static_cast<int>(rows_);
  int info = 0;
  dpotrf_("L", &n, L_.data(), &rows, &info);
  return info == 0;
}

void PotrfSolver::solve(double* x) const {
  const int n = static_cast<int>(n_), rows = static_cast<int>(rows_), one = 1;
  int info = 0;
  dpotrs_("L", &n, &one, L_.data(), &rows, x, &rows, &info);
}

}  // namespace mbs::hybrid_dense
