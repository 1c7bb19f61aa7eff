// The solvers of a scheme's matrix, one for each variant: what happens to pivots over time.
#pragma once

#include <concepts>
#include <span>
#include <vector>

#include "lu_factors.hpp"
#include "storage.hpp"

namespace mbs::csc_klu {

/// What the simulation asks of a solver; every variant is a simulation with another one.
///
/// Constructed from a pattern, which has to outlive it, first values on it and what is known of the
/// matrix. factorize() takes new values, which have to stay until the last solve() with them; false
/// if the matrix is singular, not finite or, unless it is said to be indefinite, not positive
/// definite (another call may succeed). solve() replaces a right-hand side (of all columns) by the
/// solution with the factors of the last success. start_again() forgets all values but the first:
/// what follows is as in a new solver, and solve() waits for factorize().
template <class Solver>
concept TangentSolver = std::constructible_from < Solver,
        const Pattern&, std::span<const double>,
const Structure& > &&requires(Solver solver, std::span<const double> values, std::span<double> x) {
  { solver.factorize(values) } -> std::same_as<bool>;
  solver.solve(x);
  solver.start_again();
};

/// Pivots on the diagonal, unless one is zero; see LuFactors for the rule.
inline constexpr double kDiagonalPivots = 0.0;
/// KLU's default: the diagonal entry is the pivot unless a thousand times smaller than another.
inline constexpr double kPivotTolerance = 1e-3;

/// `refactor`: ordering and pivots stay as they were found at set-up. All pivots are diagonal,
/// which is stable for every positive definite matrix, and for quasi-definite ones in a good order.
class Refactorization {
 public:
  Refactorization(const Pattern& pattern, std::span<const double> values,
                  const Structure& structure = {}, double pivot_tolerance = kDiagonalPivots);
  [[nodiscard]] bool factorize(std::span<const double> values);
  void solve(std::span<double> x) { factors_.solve(x); }
  void start_again() {}

 private:
  LuFactors factors_;
};

/// `factor`: new pivots at every call; only the ordering stays.
class Factorization {
 public:
  Factorization(const Pattern& pattern, std::span<const double> values,
                const Structure& structure = {}, double pivot_tolerance = kPivotTolerance);
  [[nodiscard]] bool factorize(std::span<const double> values) { return factors_.factor(values); }
  void solve(std::span<double> x) { factors_.solve(x); }
  void start_again() {}

 private:
  LuFactors factors_;
};

/// When stale pivots are given up.
struct Guard {
  double pivot_tolerance = kPivotTolerance;
  /// Largest max|b - T x| / max(|T| |x| + |b|) of a solution; infinity never gives up. Good pivots
  /// stay well below it in all scenes; see README.md.
  double backward_error = 1e-14;
};

/// `guarded`: pivots stay until a solution has too large a backward error or a factorization is not
/// valid; then there are new ones, and the system is solved again. T has to be symmetric.
///
///   GuardedRefactorization solver(pattern, first);
///   if (solver.factorize(values)) solver.solve(x);
///   solver.repivotings();  // 0: the pivots of `first` were good enough for `values`
class GuardedRefactorization {
 public:
  GuardedRefactorization(const Pattern& pattern, std::span<const double> values,
                         const Structure& structure = {}, Guard guard = {});
  [[nodiscard]] bool factorize(std::span<const double> values);
  void solve(std::span<double> x);
  void start_again();

  /// How often the guard gave up pivots, each time an allocation by KLU.
  [[nodiscard]] int repivotings() const { return repivotings_; }
  /// Pivots off the diagonal at present.
  [[nodiscard]] int off_diagonal_pivots() const { return factors_.off_diagonal_pivots(); }

 private:
  bool repivot();
  /// False if the backward error of x, the solution for right_, is too large or x is not finite.
  [[nodiscard]] bool is_accurate(std::span<const double> x);

  const Pattern& pattern_;
  const double bound_;               ///< Guard::backward_error
  const std::vector<double> first_;  ///< values
  LuFactors factors_;
  std::span<const double> values_;  ///< of the matrix that is factorized
  std::vector<double> right_;       ///< n; the right-hand side, as the solution overwrites it
  std::vector<double> residual_;    ///< n
  bool fresh_ = false;              ///< the pivots were chosen for this very matrix
  bool has_first_pivots_ = true;
  int repivotings_ = 0;
};

}  // namespace mbs::csc_klu
