// The solvers of a scheme's matrix, one for each variant: what happens to pivots over time.
#include "solver.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::csc_klu {

// In all constructors: if these values fail, the first step tries again.

Refactorization::Refactorization(const Pattern& pattern, std::span<const double> values,
                                 const Structure& structure, double pivot_tolerance)
    : factors_(pattern, pivot_tolerance, structure) {
  (void)factors_.factor(values);
}

bool Refactorization::factorize(std::span<const double> values) {
  return factors_.exist() ? factors_.refactor(values) : factors_.factor(values);
}

Factorization::Factorization(const Pattern& pattern, std::span<const double> values,
                             const Structure& structure, double pivot_tolerance)
    : factors_(pattern, pivot_tolerance, structure) {
  (void)factors_.factor(values);
}

GuardedRefactorization::GuardedRefactorization(const Pattern& pattern,
                                               std::span<const double> values,
                                               const Structure& structure, Guard guard)
    : pattern_(pattern),
      bound_(guard.backward_error),
      first_(values.begin(), values.end()),
      factors_(pattern, guard.pivot_tolerance, structure),
      values_(values),
      right_(pattern.columns()),
      residual_(pattern.columns()) {
  fresh_ = factors_.factor(values);
}

bool GuardedRefactorization::factorize(std::span<const double> values) {
  values_ = values;
  fresh_ = false;
  return factors_.refactor(values) || repivot();
}

void GuardedRefactorization::solve(std::span<double> x) {
  if (!fresh_) std::ranges::copy(x, right_.begin());
  factors_.solve(x);
  if (fresh_ || is_accurate(x)) return;
  (void)repivot();  // where that fails the matrix is singular: the solution is NaN
  std::ranges::copy(right_, x.begin());
  factors_.solve(x);
}

void GuardedRefactorization::start_again() {
  if (has_first_pivots_) return;
  (void)factors_.factor(first_);
  has_first_pivots_ = true;
}

bool GuardedRefactorization::repivot() {
  ++repivotings_;
  fresh_ = true;
  has_first_pivots_ = false;
  return factors_.factor(values_);
}

bool GuardedRefactorization::is_accurate(std::span<const double> x) {
  const int* const row = pattern_.row.data();
  const double* const value = values_.data();
  double scale = 0.0;
  int k = 0;
  for (int i = 0; i < pattern_.columns(); ++i) {  // column i of T is its row i
    double residual = right_[i], size = std::abs(right_[i]);
    for (const int end = pattern_.column_begin[i + 1]; k < end; ++k) {
      const double term = value[k] * x[row[k]];
      residual -= term;
      size += std::abs(term);
    }
    residual_[i] = residual;
    scale = std::max(scale, size);
  }
  const double allowed = bound_ * scale;
  long long beyond = 0;
  for (const double residual : residual_) beyond |= !(std::abs(residual) <= allowed);
  return beyond == 0;
}

}  // namespace mbs::csc_klu
