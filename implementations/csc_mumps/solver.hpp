// Multifrontal factorization of a sparse symmetric positive definite matrix by MUMPS.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace mbs::csc_mumps {

/// Pattern of the lower triangle, diagonal included, in compressed sparse columns: column j holds
/// rows row[start[j]] < ... < row[start[j + 1] - 1], the first of them j itself.
///
/// Example: [4 1; 1 8] has start 0 2 3, row 0 1 1, and the values 4 1 8.
struct LowerPattern {
  std::vector<int> start;  ///< order + 1
  std::vector<int> row;    ///< one an entry

  [[nodiscard]] int order() const { return static_cast<int>(start.size()) - 1; }
};

/// Keeps the analysis of one pattern and the factors of one matrix at a time.
class MultifrontalSolver {
 public:
  /// Analyses `pattern`. `values` (one an entry of the pattern) is shared with MUMPS: it must stay
  /// where it is and is read by every factorize(). Throws Unsupported if MUMPS cannot go on.
  MultifrontalSolver(const LowerPattern& pattern, std::span<double> values);

  /// Factorizes the shared values and solves in place: right-hand side in, solution out (order).
  /// False if the matrix is not positive definite; `x` means nothing then and solve() must not be
  /// called. MUMPS does not notice NaN without pivoting: the caller looks out for it.
  [[nodiscard]] bool factorize_and_solve(std::span<double> x);

  /// Solves in place with the last factors. False if memory ran out.
  [[nodiscard]] bool solve(std::span<double> x);

  /// The library's version as the library itself tells it.
  static std::string version();

 private:
  struct Mumps;
  struct EndMumps {
    void operator()(Mumps* mumps) const;
  };
  void analyse();

  std::vector<int> irn_, jcn_;  // the pattern as MUMPS wants it: row and column, from 1
  std::unique_ptr<Mumps, EndMumps> mumps_;
};

}  // namespace mbs::csc_mumps
