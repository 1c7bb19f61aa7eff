// SuperLU's factorization and solves on the arrays of the matrix.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver.hpp"
#include "superlu_calls.hpp"

namespace mbs::eigen_sparse {
namespace {

// Small panels and supernodes suit matrices of a few entries a column: the work space that dgstrf
// clears each time is (m + 400) panel columns. Both stay below sp_ienv(1), which sizes statistics.
constexpr int kPanelColumns = 1;
constexpr int kRelaxedColumns = 6;

}  // namespace

/// SuperLU's view of the matrix (nothing is copied, and SuperLU only reads it) and its factors.
template <class Scalar, Tuning kTuning>
struct TunedSuperlu<Scalar, kTuning>::Handle {
  Handle(const Values& values, Definiteness kind);
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
  // Larger ones are SuperLU's own; only `panels` has them.
  int panel = kTuning == Tuning::panels ? sp_ienv(1) : kPanelColumns;
  int relaxed = kTuning == Tuning::panels ? sp_ienv(2) : kRelaxedColumns;
  superlu_options_t options = options_for_diagonal_pivots();
  std::vector<int> identity, perm_r, etree;  // of columns, of rows; column elimination tree
  std::vector<int> diagonal;                 // where the diagonal of the matrix is stored
  NCPformat columns{};
  SuperMatrix view{}, lower{}, upper{};
  GlobalLU_t memory{};
  SuperLUStat_t statistics{};
};

template <class Scalar, Tuning kTuning>
TunedSuperlu<Scalar, kTuning>::Handle::Handle(const Values& values, Definiteness kind)
    : matrix(values),
      definiteness(kind),
      identity(values.cols()),
      perm_r(values.cols()),
      etree(values.cols()) {
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

template <class Scalar, Tuning kTuning>
TunedSuperlu<Scalar, kTuning>::Handle::~Handle() {
  drop_factors();
  StatFree(&statistics);
}

template <class Scalar, Tuning kTuning>
void TunedSuperlu<Scalar, kTuning>::Handle::drop_factors() {
  if (lower.Store == nullptr) return;
  Destroy_SuperNode_Matrix(&lower);
  Destroy_CompCol_Matrix(&upper);
  lower = upper = {};
}

/// Whether all numbers are finite: a wrong one in Phi_q reaches the diagonal of Phi_q^T Phi_q. In
/// a saddle-point matrix it does not, and products of entries appear in the factorization alone.
template <class Scalar, Tuning kTuning>
bool TunedSuperlu<Scalar, kTuning>::Handle::finite() const {
  if (definiteness == Definiteness::quasi) {
    return std::isfinite(
        Eigen::Map<const Side>(matrix.valuePtr(), matrix.nonZeros()).squaredNorm());
  }
  double trace = 0.0;
  for (const int slot : diagonal) trace += matrix.valuePtr()[slot];
  return std::isfinite(trace);
}

/// Whether all pivots are right and on the diagonal.
template <class Scalar, Tuning kTuning>
template <class Predicate>
bool TunedSuperlu<Scalar, kTuning>::Handle::diagonal_pivots(Predicate is_right) const {
  const auto& store = *static_cast<const SCformat*>(lower.Store);
  const auto* values = static_cast<const Scalar*>(store.nzval);
  bool right = true;
  for (int j = 0; j < lower.ncol; ++j) {
    const int row_in_supernode = j - store.sup_to_col[store.col_to_sup[j]];
    right &= is_right(values[store.nzval_colptr[j] + row_in_supernode]) && perm_r[j] == j;
  }
  return right;
}

template <class Scalar, Tuning kTuning>
bool TunedSuperlu<Scalar, kTuning>::Handle::pivots_right() const {
  return definiteness == Definiteness::positive
             ? diagonal_pivots([](Scalar pivot) { return pivot > 0; })
             : diagonal_pivots([](Scalar pivot) { return std::abs(pivot) > 0; });
}

template <class Scalar, Tuning kTuning>
TunedSuperlu<Scalar, kTuning>::TunedSuperlu(const Values& matrix, Definiteness definiteness)
    : handle_(std::make_unique<Handle>(matrix, definiteness)) {
  (void)factorize();
}

template <class Scalar, Tuning kTuning>
TunedSuperlu<Scalar, kTuning>::~TunedSuperlu() = default;

template <class Scalar, Tuning kTuning>
bool TunedSuperlu<Scalar, kTuning>::factorize() {
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
template <class Scalar, Tuning kTuning>
void TunedSuperlu<Scalar, kTuning>::solve(Side& x) {
  Handle& h = *handle_;
  constexpr auto solve_triangular = SuperluCalls<Scalar>::solve_triangular;
  char lower[] = "L", upper[] = "U", transposed[] = "T", unit[] = "U", stored[] = "N";
  int info = 0;
  solve_triangular(upper, transposed, stored, &h.lower, &h.upper, x.data(), &h.statistics, &info);
  solve_triangular(lower, transposed, unit, &h.lower, &h.upper, x.data(), &h.statistics, &info);
}

template class TunedSuperlu<double, Tuning::own>;
template class TunedSuperlu<double, Tuning::amd>;
template class TunedSuperlu<double, Tuning::colamd>;
template class TunedSuperlu<double, Tuning::panels>;
template class TunedSuperlu<float, Tuning::own>;

}  // namespace mbs::eigen_sparse
