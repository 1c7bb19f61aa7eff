// KLU behind a small interface: analysis once, factors with new or with kept pivots, solve in
// place.
#include "lu_factors.hpp"

#include <klu.h>

#include <algorithm>
#include <cmath>
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

klu_common settings(double pivot_tolerance) {
  klu_common common;
  klu_defaults(&common);
  common.btf = 0;       // T is one block; see README.md
  common.ordering = 0;  // AMD
  common.scale = -1;    // no row scaling, and no second look at a pattern that never changes
  common.tol = pivot_tolerance;
  return common;
}

/// No early exits below: vectorized, these cost next to nothing. A NaN or an infinity anywhere in
/// the matrix reaches a pivot.
bool are_positive(std::span<const double> pivots) {
  long long bad = 0;
  for (const double pivot : pivots) {
    bad |= !(pivot > 0.0) | !(pivot <= std::numeric_limits<double>::max());
  }
  return bad == 0;
}

bool are_regular(std::span<const double> pivots) {
  long long bad = 0;
  for (const double pivot : pivots) {
    const double size = std::abs(pivot);
    bad |= !(size > 0.0) | !(size <= std::numeric_limits<double>::max());
  }
  return bad == 0;
}

}  // namespace

struct LuFactors::Handles {
  Handles(const Pattern& pattern, double pivot_tolerance, const Structure& structure)
      : common(settings(pivot_tolerance)),
        is_definite(structure.kind == Structure::Kind::definite),
        columns(pattern.columns()),
        column_begin(const_cast<int*>(pattern.column_begin.data())),  // KLU's C interface only
        row(const_cast<int*>(pattern.row.data())),                    // reads them
        symbolic(analyze(structure.order), {&common}),
        numeric(nullptr, {&common}) {
    if (!symbolic) throw Unsupported("klu_analyze refused the matrix");
  }

  klu_symbolic* analyze(std::span<const int> order) {
    if (order.empty()) return klu_analyze(columns, column_begin, row, &common);
    int* const given = const_cast<int*>(order.data());
    return klu_analyze_given(columns, column_begin, row, given, given, &common);
  }

  [[nodiscard]] bool are_valid() const {
    const std::span pivots(static_cast<const double*>(numeric->Udiag), columns);
    return is_definite && common.noffdiag == 0 ? are_positive(pivots) : are_regular(pivots);
  }

  klu_common common;
  const bool is_definite;
  int columns;
  int* column_begin;
  int* row;
  std::unique_ptr<klu_symbolic, SymbolicDeleter> symbolic;
  std::unique_ptr<klu_numeric, NumericDeleter> numeric;
};

LuFactors::LuFactors(const Pattern& pattern, double pivot_tolerance, const Structure& structure)
    : klu_(std::make_unique<Handles>(pattern, pivot_tolerance, structure)) {}

LuFactors::~LuFactors() = default;

bool LuFactors::factor(std::span<const double> values) {
  Handles& klu = *klu_;
  klu.numeric.reset();  // first, so that the allocator can hand out the same memory again
  klu.numeric.reset(klu_factor(klu.column_begin, klu.row, const_cast<double*>(values.data()),
                               klu.symbolic.get(), &klu.common));
  if (klu.numeric && !klu.are_valid()) klu.numeric.reset();
  return klu.numeric != nullptr;
}

bool LuFactors::refactor(std::span<const double> values) {
  Handles& klu = *klu_;
  return klu_refactor(klu.column_begin, klu.row, const_cast<double*>(values.data()),
                      klu.symbolic.get(), klu.numeric.get(), &klu.common) &&
         klu.are_valid();
}

void LuFactors::solve(std::span<double> x) {
  Handles& klu = *klu_;
  // With the transpose, the same matrix, KLU sums up instead of scattering; but that loses digits
  // once pivots are off the diagonal: see README.md.
  const auto solve_with = klu.common.noffdiag == 0 ? klu_tsolve : klu_solve;
  if (!solve_with(klu.symbolic.get(), klu.numeric.get(), klu.columns, 1, x.data(), &klu.common)) {
    std::ranges::fill(x, std::numeric_limits<double>::quiet_NaN());
  }
}

bool LuFactors::exist() const { return klu_->numeric != nullptr; }

int LuFactors::off_diagonal_pivots() const { return klu_->common.noffdiag; }

std::string klu_version() {
  return std::to_string(KLU_MAIN_VERSION) + '.' + std::to_string(KLU_SUB_VERSION) + '.' +
         std::to_string(KLU_SUBSUB_VERSION);
}

}  // namespace mbs::csc_klu
