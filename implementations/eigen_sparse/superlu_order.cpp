// Elimination orders by SuperLU, and its options.
#include <numeric>
#include <utility>

#include "solver.hpp"
#include "superlu_calls.hpp"

namespace mbs::eigen_sparse {
namespace {

NCformat columns_of(const SparseMatrix& matrix) {
  return {static_cast<int>(matrix.nonZeros()), const_cast<double*>(matrix.valuePtr()),
          const_cast<int*>(matrix.innerIndexPtr()), const_cast<int*>(matrix.outerIndexPtr())};
}

/// `perm_c` followed by a postorder of the column elimination tree that it gives.
std::vector<int> postordered(const SparseMatrix& pattern, std::vector<int> perm_c) {
  NCformat columns = columns_of(pattern);
  SuperMatrix view = described(SLU_NC, pattern, &columns), ordered{};
  superlu_options_t options = options_for_diagonal_pivots();
  std::vector<int> etree(pattern.cols());
  sp_preorder(&options, &view, perm_c.data(), etree.data(), &ordered);
  Destroy_CompCol_Permuted(&ordered);
  return perm_c;
}

}  // namespace

superlu_options_t options_for_diagonal_pivots() {
  superlu_options_t options;
  set_default_options(&options);
  options.ColPerm = MMD_AT_PLUS_A;
  options.DiagPivotThresh = 0.0;  // the diagonal, unless it is exactly zero
  options.PrintStat = NO;
  return options;
}

template <class Scalar, Tuning kTuning>
std::vector<int> TunedSuperlu<Scalar, kTuning>::elimination_order(const SparseMatrix& pattern) {
  if (kTuning == Tuning::amd) {
    return postordered(pattern, TunedSimplicial<double, Tuning::amd>::elimination_order(pattern));
  }
  NCformat columns = columns_of(pattern);
  SuperMatrix view = described(SLU_NC, pattern, &columns);
  std::vector<int> perm_c(pattern.cols());
  get_perm_c(kTuning == Tuning::colamd ? COLAMD : MMD_AT_PLUS_A, &view, perm_c.data());
  return postordered(pattern, std::move(perm_c));
}

template <class Scalar, Tuning kTuning>
std::vector<int> TunedSuperlu<Scalar, kTuning>::equivalent_order(const SparseMatrix& pattern,
                                                                 const Followers&) {
  std::vector<int> identity(pattern.cols());
  std::iota(identity.begin(), identity.end(), 0);
  return postordered(pattern, std::move(identity));
}

std::string superlu_version() {
  return std::to_string(SUPERLU_MAJOR_VERSION) + "." + std::to_string(SUPERLU_MINOR_VERSION) + "." +
         std::to_string(SUPERLU_PATCH_VERSION);
}

template std::vector<int> TunedSuperlu<double, Tuning::own>::elimination_order(const SparseMatrix&);
template std::vector<int> TunedSuperlu<double, Tuning::amd>::elimination_order(const SparseMatrix&);
template std::vector<int> TunedSuperlu<double, Tuning::colamd>::elimination_order(
    const SparseMatrix&);
template std::vector<int> TunedSuperlu<double, Tuning::panels>::elimination_order(
    const SparseMatrix&);
template std::vector<int> TunedSuperlu<double, Tuning::own>::equivalent_order(const SparseMatrix&,
                                                                              const Followers&);
template std::vector<int> TunedSuperlu<double, Tuning::amd>::equivalent_order(const SparseMatrix&,
                                                                              const Followers&);
template std::vector<int> TunedSuperlu<double, Tuning::colamd>::equivalent_order(
    const SparseMatrix&, const Followers&);
template std::vector<int> TunedSuperlu<double, Tuning::panels>::equivalent_order(
    const SparseMatrix&, const Followers&);
template std::vector<int> TunedSuperlu<float, Tuning::own>::elimination_order(const SparseMatrix&);
template std::vector<int> TunedSuperlu<float, Tuning::own>::equivalent_order(const SparseMatrix&,
                                                                             const Followers&);

}  // namespace mbs::eigen_sparse
