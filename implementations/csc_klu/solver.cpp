// KLU behind a small interface: symbolic analysis once, numeric refactorization, solve in place.
#include "solver.hpp"

#include <klu.h>

#include <limits>

#include "mbs/simulation.hpp"

namespace mbs::csc_klu {
namespace {

struct SymbolicDeleter {
  klu_common* common;
  void operator()(klu_symbolic* symbolic) const { klu_free_symbolic(&symbolic, common); }
};

struct NumericDeleter {
  klu_common* common;
  void operator()(klu_numeric* numeric) const { klu_free_numeric(&numeric, common); }
};

klu_common settings() {
  klu_common common;
  klu_defaults(&common);
  common.btf = 0;       // T is one block; see README.md
  common.ordering = 0;  // AMD
  common.scale = -1;    // no row scaling, and no second look at a pattern that never changes
  common.tol = 0.0;     // T is positive definite: pivots on the diagonal are stable for any values
  return common;
}

/// With all pivots on the diagonal, T is positive definite exactly if they are positive. A NaN or
/// an infinity anywhere in T reaches a pivot.
bool is_positive_definite(const klu_numeric& numeric) {
  const auto* const pivot = static_cast<const double*>(numeric.Udiag);
  long long bad = 0;  // no early exit: vectorized, this costs next to nothing
  for (int k = 0; k < numeric.n; ++k) {
    bad |= !(pivot[k] > 0.0) | !(pivot[k] <= std::numeric_limits<double>::max());
  }
  return bad == 0;
}

}  // namespace

struct Refactorization::Handles {
  explicit Handles(const Pattern& pattern)
      : columns(pattern.columns()),
        column_begin(const_cast<int*>(pattern.column_begin.data())),  // KLU's C interface only
        row(const_cast<int*>(pattern.row.data())),                    // reads them
        symbolic(klu_analyze(columns, column_begin, row, &common), {&common}),
        numeric(nullptr, {&common}) {
    if (!symbolic) throw Unsupported("klu_analyze refused the tangent matrix");
  }

  klu_common common = settings();
  int columns;
  int* column_begin;
  int* row;
  std::unique_ptr<klu_symbolic, SymbolicDeleter> symbolic;
  std::unique_ptr<klu_numeric, NumericDeleter> numeric;
};

Refactorization::Refactorization(const Pattern& pattern, std::span<const double> values)
    : klu_(std::make_unique<Handles>(pattern)) {
  (void)factorize(values);  // if these values fail, the first step tries again
}

Refactorization::~Refactorization() = default;

bool Refactorization::factorize(std::span<const double> values) {
  Handles& klu = *klu_;
  auto* const x = const_cast<double*>(values.data());
  if (klu.numeric) {
    return klu_refactor(klu.column_begin, klu.row, x, klu.symbolic.get(), klu.numeric.get(),
                        &klu.common) &&
           is_positive_definite(*klu.numeric);
  }
  klu.numeric.reset(klu_factor(klu.column_begin, klu.row, x, klu.symbolic.get(), &klu.common));
  if (klu.numeric && !is_positive_definite(*klu.numeric)) klu.numeric.reset();
  return klu.numeric != nullptr;
}

void Refactorization::solve(std::span<double> x) {
  klu_solve(klu_->symbolic.get(), klu_->numeric.get(), klu_->columns, 1, x.data(), &klu_->common);
}

std::string klu_version() {
  return std::to_string(KLU_MAIN_VERSION) + '.' + std::to_string(KLU_SUB_VERSION) + '.' +
         std::to_string(KLU_SUBSUB_VERSION);
}

}  // namespace mbs::csc_klu
