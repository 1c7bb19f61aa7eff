#include "solver.hpp"

#include <Eigen/Cholesky>

extern "C" {
void ilaver_(int* major, int* minor, int* patch);
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dtrsv_(const char* uplo, const char* trans, const char* diag, const int* n, const double* a,
            const int* lda, double* x, const int* incx);
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m,
            const int* n, const double* alpha, const double* a, const int* lda, double* b,
            const int* ldb);
void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* beta, double* c, const int* ldc);
void dpotrs_(const char* uplo, const int* n, const int* nrhs, const double* a, const int* lda,
             double* b, const int* ldb, int* info);
}

namespace mbs::hybrid_dense {
namespace {

constexpr int kAlignment = kWidth * sizeof(double);
template <class Matrix>
using Columns = Eigen::Map<Matrix, kAlignment, Eigen::OuterStride<>>;

// Up to here Eigen's unblocked factorization is the fastest; measured.
constexpr long kUnblocked = 64;

// Halves, so that products are as large as they can be: Eigen's pack their factors, which narrow
// ones do not repay. Eigen's own blocks are of 8 where n is below 128.
bool factorize_halves(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> L) {
  using Factorization = Eigen::internal::llt_inplace<double, Eigen::Lower>;
  const long n = L.rows();
  if (n <= kUnblocked) return Factorization::unblocked(L) < 0;
  const long size = padded(n / 2), rest = n - size;
  auto diagonal = L.topLeftCorner(size, size);
  auto below = L.bottomLeftCorner(rest, size);
  auto remainder = L.bottomRightCorner(rest, rest);
  if (!factorize_halves(diagonal)) return false;
  diagonal.triangularView<Eigen::Lower>().adjoint().solveInPlace<Eigen::OnTheRight>(below);
  remainder.selfadjointView<Eigen::Lower>().rankUpdate(below, -1.0);
  return factorize_halves(remainder);
}

}  // namespace

std::string library_versions() {
  int major = 0, minor = 0, patch = 0;
  ilaver_(&major, &minor, &patch);
  const auto join = [](int a, int b, int c) {
    return std::to_string(a) + '.' + std::to_string(b) + '.' + std::to_string(c);
  };
  return join(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION) + ", " +
         join(major, minor, patch);
}

bool LltSolver::factorize() {
  copy();
  Columns<Eigen::MatrixXd> L(L_.data(), n_, n_, Eigen::OuterStride<>(rows_));
  return factorize_halves(L) && is_positive();
}

bool LltBlocksSolver::factorize() {
  copy();
  Columns<Eigen::MatrixXd> L(L_.data(), n_, n_, Eigen::OuterStride<>(rows_));
  return Eigen::internal::llt_inplace<double, Eigen::Lower>::blocked(L) < 0 && is_positive();
}

void LltSolver::solve_lower(double* x) const {
  const Columns<const Eigen::MatrixXd> L(L_.data(), n_, n_, Eigen::OuterStride<>(rows_));
  Eigen::Map<Eigen::VectorXd, kAlignment> solution(x, n_);
  L.triangularView<Eigen::Lower>().solveInPlace(solution);
}

void LltSolver::solve_upper(double* x) const {
  const Columns<const Eigen::MatrixXd> L(L_.data(), n_, n_, Eigen::OuterStride<>(rows_));
  Eigen::Map<Eigen::VectorXd, kAlignment> solution(x, n_);
  L.triangularView<Eigen::Lower>().adjoint().solveInPlace(solution);
}

void LltSolver::solve(double* x, long count, long stride) const {
  const Columns<const Eigen::MatrixXd> L(L_.data(), n_, n_, Eigen::OuterStride<>(rows_));
  Columns<Eigen::MatrixXd> solutions(x, n_, count, Eigen::OuterStride<>(stride));
  L.triangularView<Eigen::Lower>().solveInPlace(solutions);
  L.triangularView<Eigen::Lower>().adjoint().solveInPlace(solutions);
}

void LltSolver::multiply(double* x, long count, long stride, LltSolver& products) const {
  const Columns<const Eigen::MatrixXd> L(L_.data(), n_, n_, Eigen::OuterStride<>(rows_));
  Columns<Eigen::MatrixXd> columns(x, n_, count, Eigen::OuterStride<>(stride));
  Columns<Eigen::MatrixXd> A(products.A_.data(), count, count,
                             Eigen::OuterStride<>(products.rows_));
  L.triangularView<Eigen::Lower>().solveInPlace(columns);
  A.triangularView<Eigen::Lower>().setZero();
  A.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
}

bool PotrfSolver::factorize() {
  copy();
  const int n = static_cast<int>(n_), rows = static_cast<int>(rows_);
  int info = 0;
  dpotrf_("L", &n, L_.data(), &rows, &info);
  return info == 0 && is_positive();
}

void PotrfSolver::multiply(double* x, long count, long stride, PotrfSolver& products) const {
  const int n = static_cast<int>(n_), rows = static_cast<int>(rows_);
  const int columns = static_cast<int>(count), apart = static_cast<int>(stride);
  const int below = static_cast<int>(products.rows_);
  const double one = 1.0, zero = 0.0;
  dtrsm_("L", "L", "N", "N", &n, &columns, &one, L_.data(), &rows, x, &apart);
  dsyrk_("L", "T", &columns, &n, &one, x, &apart, &zero, products.A_.data(), &below);
}

void PotrfSolver::solve_lower(double* x) const {
  const int n = static_cast<int>(n_), rows = static_cast<int>(rows_), one = 1;
  dtrsv_("L", "N", "N", &n, L_.data(), &rows, x, &one);
}

void PotrfSolver::solve_upper(double* x) const {
  const int n = static_cast<int>(n_), rows = static_cast<int>(rows_), one = 1;
  dtrsv_("L", "T", "N", &n, L_.data(), &rows, x, &one);
}

void PotrfSolver::solve(double* x, long count, long stride) const {
  const int n = static_cast<int>(n_), rows = static_cast<int>(rows_);
  const int columns = static_cast<int>(count), apart = static_cast<int>(stride);
  int info = 0;
  dpotrs_("L", &n, &columns, L_.data(), &rows, x, &apart, &info);
}

}  // namespace mbs::hybrid_dense
