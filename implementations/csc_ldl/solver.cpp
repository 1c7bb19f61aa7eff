// LDL behind three calls. Its documentation is the user guide of SuiteSparse's LDL and ldl.h.
#include "solver.hpp"

#include <utility>

extern "C" {  // ldl.h does not say so itself
#include <ldl.h>
}

namespace mbs::csc_ldl {

std::string ldl_version() {
  return std::to_string(LDL_MAIN_VERSION) + "." + std::to_string(LDL_SUB_VERSION) + "." +
         std::to_string(LDL_SUBSUB_VERSION);
}

LdlSolver::LdlSolver(UpperPattern pattern, std::vector<double> sign)
    : pattern_(std::move(pattern)), values_(pattern_.row.size()), sign_(std::move(sign)) {
  const int n = pattern_.size;
  L_begin_.resize(n + 1);
  for (std::vector<int>* each : {&parent_, &L_count_, &stack_, &flag_}) each->resize(n);
  D_.resize(n);
  inverse_D_.resize(n);
  row_.resize(n);
  // No permutation: the matrix is assembled in the order of elimination.
  ldl_symbolic(n, pattern_.begin.data(), pattern_.row.data(), L_begin_.data(), parent_.data(),
               L_count_.data(), flag_.data(), nullptr, nullptr);
  L_row_.resize(L_begin_[n]);
  L_.resize(L_begin_[n]);
}

bool LdlSolver::factorize() {
  const int n = pattern_.size;
  if (ldl_numeric(n, pattern_.begin.data(), pattern_.row.data(), values_.data(), L_begin_.data(),
                  parent_.data(), L_count_.data(), L_row_.data(), L_.data(), D_.data(), row_.data(),
                  stack_.data(), flag_.data(), nullptr, nullptr) != n) {
    return false;
  }
  bool sound = true;
  for (int k = 0; k < n; ++k) {
    sound &= sign_[k] * D_[k] > 0.0;  // false for NaN, too
    inverse_D_[k] = 1 / D_[k];
  }
  return sound;
}

// What ldl_lsolve(), ldl_dsolve() and ldl_ltsolve() do, on the same arrays. The library's keep sums
// in memory, as nothing tells their compiler that x and L do not overlap.
void LdlSolver::solve(double* __restrict x) const {
  const int n = pattern_.size, *begin = L_begin_.data(), *row = L_row_.data();
  const double *L = L_.data(), *inverse_D = inverse_D_.data();
  for (int j = 0, k = 0; j < n; ++j) {
    const double x_j = x[j];
    for (; k < begin[j + 1]; ++k) x[row[k]] -= L[k] * x_j;
  }
  for (int j = 0; j < n; ++j) x[j] *= inverse_D[j];
  for (int j = n - 1, k = begin[n] - 1; j >= 0; --j) {
    double x_j = x[j];
    for (; k >= begin[j]; --k) x_j -= L[k] * x[row[k]];
    x[j] = x_j;
  }
}

}  // namespace mbs::csc_ldl
