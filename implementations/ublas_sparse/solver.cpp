// KLU behind the interface of solver.hpp.
#include "solver.hpp"

#include <klu.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs::ublas_sparse {
namespace {

struct FreeSymbolic {
  klu_common* common;
  void operator()(klu_symbolic* symbolic) const { klu_free_symbolic(&symbolic, common); }
};
struct FreeNumeric {
  klu_common* common;
  void operator()(klu_numeric* numeric) const { klu_free_numeric(&numeric, common); }
};

}  // namespace

struct KluSolver::Klu {
  explicit Klu(const SparseMatrix& pattern)
      : start(pattern.index1_data()),
        row(pattern.index2_data()),
        value(pattern.nnz()),
        symbolic(nullptr, {&common}),
        numeric(nullptr, {&common}) {
    klu_defaults(&common);
    common.tol = 0.0;   // pivot on the diagonal
    common.scale = -1;  // none: it would not change which pivots are taken
    common.btf = 0;     // of a symmetric matrix this form is block diagonal: AMD sees that
    symbolic.reset(klu_analyze(size(), start.data(), row.data(), &common));
    if (!symbolic) {
      throw Unsupported("klu_analyze: status " + std::to_string(common.status));
    }
  }
  [[nodiscard]] int size() const { return static_cast<int>(start.size()) - 1; }

  klu_common common;
  std::vector<int> start, row;  // of the pattern
  std::vector<double> value;
  bool finite = false;
  std::unique_ptr<klu_symbolic, FreeSymbolic> symbolic;
  std::unique_ptr<klu_numeric, FreeNumeric> numeric;
};

KluSolver::KluSolver(const SparseMatrix& pattern) : klu_(std::make_unique<Klu>(pattern)) {}
KluSolver::~KluSolver() = default;

void KluSolver::load(SparseMatrix& T) {
  T.complete_index1_data();
  const auto& T_start = T.index1_data();
  const auto& T_row = T.index2_data();
  const auto& T_value = T.value_data();
  Klu& klu = *klu_;
  double sum = 0.0;
  for (int j = 0; j < klu.size(); ++j) {
    int k = klu.start[j];
    for (int p = T_start[j]; p < T_start[j + 1]; ++p) {
      while (klu.row[k] != T_row[p]) klu.value[k++] = 0.0;  // dropped by uBLAS
      klu.value[k++] = T_value[p];
      sum += T_value[p];
    }
    std::fill(klu.value.begin() + k, klu.value.begin() + klu.start[j + 1], 0.0);
  }
  klu.finite = std::isfinite(sum);
}

bool KluSolver::factorize() {
  Klu& klu = *klu_;
  if (!klu.finite) return false;
  if (!klu.numeric) {
    klu.numeric.reset(klu_factor(klu.start.data(), klu.row.data(), klu.value.data(),
                                 klu.symbolic.get(), &klu.common));
    if (!klu.numeric) return false;
  } else if (!klu_refactor(klu.start.data(), klu.row.data(), klu.value.data(), klu.symbolic.get(),
                           klu.numeric.get(), &klu.common)) {
    return false;
  }
  const double* pivot = static_cast<const double*>(klu.numeric->Udiag);
  return std::all_of(pivot, pivot + klu.size(), [](double u) { return u > 0.0; });  // NaN: false
}

void KluSolver::solve(Vector& b) {
  klu_solve(klu_->symbolic.get(), klu_->numeric.get(), klu_->size(), 1, b.data().data(),
            &klu_->common);
}

}  // namespace mbs::ublas_sparse
