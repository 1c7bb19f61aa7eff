// UMFPACK for a matrix of constant pattern: one analysis, then a factorization every pass.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "numeric_memory.hpp"
#include "pattern.hpp"

namespace mbs::csc_umfpack {

/// What is asked of UMFPACK.
enum class Tuning {
  own,       ///< what was fastest here: README.md, "Choices in UMFPACK"
  amd,       ///< the same, always in AMD's order
  metis,     ///< the same, always in that of METIS
  trees,     ///< the same, always in one of minimum degree with low trees
  defaults,  ///< UMFPACK's: strategy of its choice, scaling, thresholds, refinement
};

/// Orders of elimination.
using Orders = std::vector<std::vector<int>>;

/// Solves A x = b, where A is symmetric and has the pattern that the solver was made from, which
/// must outlive it. Pivots are taken from the diagonal: A is positive definite, or quasi-definite
/// and given with an order in which its diagonal will do.
class Solver {
 public:
  /// Analyses the pattern. `orders` list what to eliminate from first to last: as orders_of() has
  /// them, or none, where UMFPACK orders by itself. Throws Unsupported if UMFPACK refuses the
  /// pattern.
  Solver(const SparsityPattern& pattern, Tuning tuning, const Orders& orders = {});

  /// `A` are values in the order of the pattern. False if A is singular or not finite, or if memory
  /// runs out; solve() must not be called then.
  [[nodiscard]] bool factorize(const double* A);
  /// x = A^-1 b with the last factorization, whose values are still there; x and b (n) do not
  /// overlap.
  void solve(const double* b, double* x);

 private:
  void tune(Tuning tuning);
  void analyse(int ordering, const int* given);
  /// Of a factorization with the last analysis: UMFPACK foresees only a bound, which misleads.
  [[nodiscard]] double count_operations();

  struct FreeSymbolic {
    void operator()(void* symbolic) const;
  };
  struct FreeNumeric {
    NumericMemory* memory;
    void operator()(void* numeric) const;
  };

  const SparsityPattern& pattern_;
  std::array<double, 20> control_{};  ///< UMFPACK_CONTROL
  std::array<double, 90> info_{};     ///< UMFPACK_INFO
  std::vector<int> integers_;         ///< n, workspace of solve()
  std::vector<double> reals_;         ///< 5 n, the same
  const double* values_ = nullptr;    ///< of the last factorization
  std::unique_ptr<void, FreeSymbolic> symbolic_;
  NumericMemory memory_;
  std::unique_ptr<void, FreeNumeric> numeric_{nullptr, {&memory_}};
};

}  // namespace mbs::csc_umfpack
