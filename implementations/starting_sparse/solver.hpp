// Sparse LDL' of a symmetric matrix in coordinate format, duplicates allowed, by MUMPS.
#pragma once

#include <memory>
#include <span>
#include <string>

namespace mbs::starting_sparse {

/// Lower triangle of a symmetric matrix as a list of entries (rows[k], columns[k], values[k]),
/// 1-based as in Fortran. An entry may be listed any number of times: the solver adds the
/// duplicates up.
///
/// Example: rows 1 2 2 2, columns 1 1 2 2, values 4 1 3 5 is the matrix [4 1; 1 8].
struct CoordinateMatrix {
  int order = 0;
  std::span<const int> rows;       ///< 1 .. order
  std::span<const int> columns;    ///< columns[k] <= rows[k]
  std::span<const double> values;  ///< read by every factorization
};

/// One analysis, then any number of factorizations and solutions.
class Solver {
 public:
  /// Symbolic analysis of the pattern. The arrays of `matrix` must outlive the solver and stay
  /// where they are. Throws Unsupported if MUMPS refuses.
  explicit Solver(const CoordinateMatrix& matrix);

  /// Factorizes the values as they are now and overwrites the right-hand side `x` (order) with the
  /// solution. False if the matrix is not positive definite (singular, negative pivots, not a
  /// number), after which solve() must not be called.
  [[nodiscard]] bool factorize_and_solve(double* x);

  /// Overwrites `x` (order) with the solution for the last factorization. False if MUMPS ran out of
  /// memory.
  [[nodiscard]] bool solve(double* x);

  /// The version of MUMPS as the library reports it.
  static std::string library_version();

 private:
  struct Instance;
  struct TerminateInstance {
    void operator()(Instance* instance) const;
  };
  using Handle = std::unique_ptr<Instance, TerminateInstance>;
  static Handle initialize();

  Handle mumps_;
};

}  // namespace mbs::starting_sparse
