// SuperLU's factorization and solves on the arrays of the tangent matrix.
#include <superlu/slu_ddefs.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver.hpp"

namespace mbs::eigen_superlu {
namespace {

// Small panels and supernodes suit tangents of a few entries a column: the work space that dgstrf
// clears each time is (m + 400) panel columns. Both stay below sp_ienv(1), which sizes statistics.
constexpr int kPanelColumns = 1;
constexpr int kRelaxedColumns = 6;

superlu_options_t default_options() {
  superlu_options_t options;
  set_default_options(&options);
  options.ColPerm = MMD_AT_PLUS_A;
  options.DiagPivotThresh = 0.0;  // the diagonal, unless it is exactly zero
  options.PrintStat = NO;
  return options;
}

SuperMatrix described(Stype_t storage, const SparseMatrix& matrix, void* store) {
  const auto n = static_cast<int>(matrix.cols());
  return {storage, SLU_D, SLU_GE, n, n, store};
}

}  // namespace

/// SuperLU's view of the tangent (nothing is copied, and SuperLU only reads it) and its factors.
struct SuperluSolver::Handle {
  explicit Handle(const SparseMatrix& matrix);
  ~Handle();
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  [[nodiscard]] bool finite() const;
  [[nodiscard]] bool positive() const;
  void drop_factors();

  const SparseMatrix& tangent;
  superlu_options_t options = default_options();
  std::vector<int> identity, perm_r, etree;  // of columns, of rows; column elimination tree
  std::vector<int> diagonal;                 // where the diagonal of the tangent is stored
  NCPformat columns{};
  SuperMatrix view{}, lower{}, upper{};
  GlobalLU_t memory{};
  SuperLUStat_t statistics{};
};

SuperluSolver::Handle::Handle(const SparseMatrix& matrix)
    : tangent(matrix), identity(matrix.cols()), perm_r(matrix.cols()), etree(matrix.cols()) {
  std::iota(identity.begin(), identity.end(), 0);
  int* starts = const_cast<int*>(matrix.outerIndexPtr());
  int* rows = const_cast<int*>(matrix.innerIndexPtr());
  columns = {static_cast<int>(matrix.nonZeros()), const_cast<double*>(matrix.valuePtr()), rows,
             starts, starts + 1};
  view = described(SLU_NCP, matrix, &columns);
  sp_coletree(starts, starts + 1, rows, view.nrow, view.ncol, etree.data());
  for (int j = 0; j < view.ncol; ++j) {
    diagonal.push_back(
        static_cast<int>(std::find(rows + starts[j], rows + starts[j + 1], j) - rows));
  }
  StatInit(&statistics);
}

SuperluSolver::Handle::~Handle() {
  drop_factors();
  StatFree(&statistics);
}

void SuperluSolver::Handle::drop_factors() {
  if (lower.Store == nullptr) return;
  Destroy_SuperNode_Matrix(&lower);
  Destroy_CompCol_Matrix(&upper);
  lower = upper = {};
}

/// Whether all numbers are finite: a wrong one in Phi_q reaches the diagonal of Phi_q^T Phi_q.
bool SuperluSolver::Handle::finite() const {
  double trace = 0.0;
  for (const int slot : diagonal) trace += tangent.valuePtr()[slot];
  return std::isfinite(trace);
}

/// Whether the pivots are positive and on the diagonal, hence the tangent positive definite.
bool SuperluSolver::Handle::positive() const {
  const auto& store = *static_cast<const SCformat*>(lower.Store);
  const auto* values = static_cast<const double*>(store.nzval);
  bool positive = true;
  for (int j = 0; j < lower.ncol; ++j) {
    const int row_in_supernode = j - store.sup_to_col[store.col_to_sup[j]];
    positive &= values[store.nzval_colptr[j] + row_in_supernode] > 0.0 && perm_r[j] == j;
  }
  return positive;
}

std::vector<int> SuperluSolver::elimination_order(const SparseMatrix& pattern) {
  NCformat columns{static_cast<int>(pattern.nonZeros()), const_cast<double*>(pattern.valuePtr()),
                   const_cast<int*>(pattern.innerIndexPtr()),
                   const_cast<int*>(pattern.outerIndexPtr())};
  SuperMatrix view = described(SLU_NC, pattern, &columns), ordered{};
  superlu_options_t options = default_options();
  std::vector<int> perm_c(pattern.cols()), etree(pattern.cols());
  get_perm_c(options.ColPerm, &view, perm_c.data());
  sp_preorder(&options, &view, perm_c.data(), etree.data(), &ordered);
  Destroy_CompCol_Permuted(&ordered);
  return perm_c;
}

std::string SuperluSolver::version() {
  return std::to_string(SUPERLU_MAJOR_VERSION) + "." + std::to_string(SUPERLU_MINOR_VERSION) + "." +
         std::to_string(SUPERLU_PATCH_VERSION);
}

SuperluSolver::SuperluSolver(const SparseMatrix& tangent)
    : handle_(std::make_unique<Handle>(tangent)) {
  (void)factorize();
}

SuperluSolver::~SuperluSolver() = default;

bool SuperluSolver::factorize() {
  Handle& h = *handle_;
  // Pivoting past a NaN would leave the pattern that L and U have room for.
  if (!h.finite()) return false;
  h.options.Fact = h.lower.Store == nullptr ? DOFACT : SamePattern_SameRowPerm;
  int info = 0;
  dgstrf(&h.options, &h.view, kRelaxedColumns, kPanelColumns, h.etree.data(), nullptr, 0,
         h.identity.data(), h.perm_r.data(), &h.lower, &h.upper, &h.memory, &h.statistics, &info);
  if (info > h.view.ncol) {  // out of memory: what the factors point to is not known
    h.lower.Store = h.upper.Store = nullptr;
    return false;
  }
  if (info == 0 && h.positive()) return true;
  h.drop_factors();
  return false;
}

/// T = L U is symmetric: U^T y = b and L^T x = y gather along columns and are faster than L, U.
void SuperluSolver::solve(Vector& x) {
  Handle& h = *handle_;
  char lower[] = "L", upper[] = "U", transposed[] = "T", unit[] = "U", stored[] = "N";
  int info = 0;
  sp_dtrsv(upper, transposed, stored, &h.lower, &h.upper, x.data(), &h.statistics, &info);
  sp_dtrsv(lower, transposed, unit, &h.lower, &h.upper, x.data(), &h.statistics, &info);
}

}  // namespace mbs::eigen_superlu
