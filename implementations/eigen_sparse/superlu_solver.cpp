// SuperLU's factorization and solves on the arrays of the matrix.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "solver.hpp"
#include "superlu_calls.hpp"

namespace mbs::eigen_sparse {
namespace {

// Small panels and supernodes suit matrices of a few entries a column: the work space that dgstrf
// clears each time is (m + 400) panel columns. Both stay below sp_ienv(1), which sizes statistics.
constexpr int kPanelColumns = 1;
constexpr int kRelaxedColumns = 6;
// As many operations take as long as what a supernode takes besides.
constexpr double kOperationsOfASupernode = 250.0;

}  // namespace

/// SuperLU's view of the matrix (nothing is copied, and SuperLU only reads it) and its factors.
template <class Scalar>
struct SuperluSolver<Scalar>::Handle {
  Handle(const Values& values, Definiteness kind, Tuning tuning);
  ~Handle();
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  [[nodiscard]] bool finite() const;
  template <class Predicate>
  [[nodiscard]] bool diagonal_pivots(Predicate is_right) const;
  [[nodiscard]] bool pivots_right() const;
  void drop_factors();

  const Values& matrix;
  Definiteness definiteness;
  int panel = kPanelColumns, relaxed = kRelaxedColumns;
  superlu_options_t options = options_for_diagonal_pivots();
  std::vector<int> identity, perm_r, etree;  // of columns, of rows; column elimination tree
  std::vector<int> diagonal;                 // where the diagonal of the matrix is stored
  NCPformat columns{};
  SuperMatrix view{}, lower{}, upper{};
  GlobalLU_t memory{};
  SuperLUStat_t statistics{};
};

template <class Scalar>
SuperluSolver<Scalar>::Handle::Handle(const Values& values, Definiteness kind, Tuning tuning)
    : matrix(values),
      definiteness(kind),
      identity(values.cols()),
      perm_r(values.cols()),
      etree(values.cols()) {
  if (tuning == Tuning::panels) {  // larger ones, SuperLU's own
    panel = sp_ienv(1);
    relaxed = sp_ienv(2);
  }
  std::iota(identity.begin(), identity.end(), 0);
  int* starts = const_cast<int*>(matrix.outerIndexPtr());
  int* rows = const_cast<int*>(matrix.innerIndexPtr());
  columns = {static_cast<int>(matrix.nonZeros()), const_cast<Scalar*>(matrix.valuePtr()), rows,
             starts, starts + 1};
  view = described(SLU_NCP, matrix, &columns);
  sp_coletree(starts, starts + 1, rows, view.nrow, view.ncol, etree.data());
  for (int j = 0; j < view.ncol; ++j) {
    diagonal.push_back(
        static_cast<int>(std::find(rows + starts[j], rows + starts[j + 1], j) - rows));
  }
  StatInit(&statistics);
}

template <class Scalar>
SuperluSolver<Scalar>::Handle::~Handle() {
  drop_factors();
  StatFree(&statistics);
}

template <class Scalar>
void SuperluSolver<Scalar>::Handle::drop_factors() {
  if (lower.Store == nullptr) return;
  Destroy_SuperNode_Matrix(&lower);
  Destroy_CompCol_Matrix(&upper);
  lower = upper = {};
}

/// Whether all numbers are finite: a wrong one in Phi_q reaches the diagonal of Phi_q^T Phi_q. In
/// a saddle-point matrix it does not, and products of entries appear in the factorization alone.
template <class Scalar>
bool SuperluSolver<Scalar>::Handle::finite() const {
  if (definiteness == Definiteness::quasi) {
    return std::isfinite(
        Eigen::Map<const Side>(matrix.valuePtr(), matrix.nonZeros()).squaredNorm());
  }
  double trace = 0.0;
  for (const int slot : diagonal) trace += matrix.valuePtr()[slot];
  return std::isfinite(trace);
}

/// Whether all pivots are right and on the diagonal.
template <class Scalar>
template <class Predicate>
bool SuperluSolver<Scalar>::Handle::diagonal_pivots(Predicate is_right) const {
  const auto& store = *static_cast<const SCformat*>(lower.Store);
  const auto* values = static_cast<const Scalar*>(store.nzval);
  bool right = true;
  for (int j = 0; j < lower.ncol; ++j) {
    const int row_in_supernode = j - store.sup_to_col[store.col_to_sup[j]];
    right &= is_right(values[store.nzval_colptr[j] + row_in_supernode]) && perm_r[j] == j;
  }
  return right;
}

template <class Scalar>
bool SuperluSolver<Scalar>::Handle::pivots_right() const {
  return definiteness == Definiteness::positive
             ? diagonal_pivots([](Scalar pivot) { return pivot > 0; })
             : diagonal_pivots([](Scalar pivot) { return std::abs(pivot) > 0; });
}

template <class Scalar>
SuperluSolver<Scalar>::SuperluSolver(const Values& matrix, Definiteness definiteness, Tuning tuning)
    : handle_(std::make_unique<Handle>(matrix, definiteness, tuning)) {
  (void)factorize();
}

template <class Scalar>
SuperluSolver<Scalar>::~SuperluSolver() = default;

template <class Scalar>
bool SuperluSolver<Scalar>::factorize() {
  Handle& h = *handle_;
  // Pivoting past a NaN would leave the pattern that L and U have room for.
  if (!h.finite()) return false;
  h.options.Fact = h.lower.Store == nullptr ? DOFACT : SamePattern_SameRowPerm;
  int info = 0;
  SuperluCalls<Scalar>::factorize(&h.options, &h.view, h.relaxed, h.panel, h.etree.data(), nullptr,
                                  0, h.identity.data(), h.perm_r.data(), &h.lower, &h.upper,
                                  &h.memory, &h.statistics, &info);
  if (info > h.view.ncol) {  // out of memory: what the factors point to is not known
    h.lower.Store = h.upper.Store = nullptr;
    return false;
  }
  if (info == 0 && h.pivots_right()) return true;
  h.drop_factors();
  return false;
}

/// The matrix is symmetric: U^T y = b and L^T x = y gather along columns and are faster than L, U.
template <class Scalar>
void SuperluSolver<Scalar>::solve(Side& x) {
  Handle& h = *handle_;
  constexpr auto solve_triangular = SuperluCalls<Scalar>::solve_triangular;
  char lower[] = "L", upper[] = "U", transposed[] = "T", unit[] = "U", stored[] = "N";
  int info = 0;
  solve_triangular(upper, transposed, stored, &h.lower, &h.upper, x.data(), &h.statistics, &info);
  solve_triangular(lower, transposed, unit, &h.lower, &h.upper, x.data(), &h.statistics, &info);
}

/// SuperLU counts zeros that relaxed supernodes store too.
template <class Scalar>
double SuperluSolver<Scalar>::cost() const {
  if (handle_->lower.Store == nullptr) return std::numeric_limits<double>::infinity();
  const auto& factor = *static_cast<const SCformat*>(handle_->lower.Store);
  return handle_->statistics.ops[FACT] + kOperationsOfASupernode * (factor.nsuper + 1);
}

template class SuperluSolver<double>;
template class SuperluSolver<float>;

}  // namespace mbs::eigen_sparse
