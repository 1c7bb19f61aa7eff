// Multifrontal factorization of a sparse symmetric matrix, definite or quasi-definite, by MUMPS.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pattern.hpp"

namespace mbs::csc_mumps {

/// What is asked of MUMPS.
enum class Tuning {
  own,       ///< what was fastest here: README.md, "MUMPS here"
  amd,       ///< the same, always in an order of approximate minimum degree
  scotch,    ///< the same, always in that of Scotch
  metis,     ///< the same, always in that of METIS
  trees,     ///< the same, always in one of minimum degree with low trees
  defaults,  ///< order, amalgamation and scaling as MUMPS chooses them
};

/// Keeps the analysis of one pattern and the factors of one matrix at a time. `values` (one an
/// entry of the pattern) is shared with MUMPS: it must stay where it is and is read by every
/// factorization. Constructors throw Unsupported if MUMPS cannot go on.
class MultifrontalSolver {
 public:
  /// Of positive definite matrices: without pivoting, in a fill-reducing order.
  MultifrontalSolver(Triplets pattern, std::span<double> values, Tuning tuning);
  /// Of quasi-definite ones: variable i is eliminated as number position[i], from 1, as far as
  /// pivots allow it.
  MultifrontalSolver(Triplets pattern, std::span<double> values, std::vector<int> position);

  /// Factorizes the shared values and solves in place: right-hand side in, solution out (order).
  /// False if the matrix is singular, or should be positive definite and is not; `x` means nothing
  /// then and solve() must not be called. MUMPS does not notice NaN: the caller looks out for it.
  [[nodiscard]] bool factorize_and_solve(std::span<double> x);

  /// Solves in place with the last factors. False if memory ran out.
  [[nodiscard]] bool solve(std::span<double> x);

  /// When each variable is eliminated, from 1: by minimum degree, or as tuned. Entries may be
  /// repeated.
  static std::vector<int> positions(Triplets pattern, Tuning tuning);
  /// The library's version as the library itself tells it.
  static std::string version();

 private:
  struct Mumps;
  struct EndMumps {
    void operator()(Mumps* mumps) const;
  };
  void share(std::span<double> values);
  void analyse(std::span<const int> orderings);

  Triplets pattern_;
  std::vector<int> position_;  // of quasi-definite matrices
  std::unique_ptr<Mumps, EndMumps> mumps_;
};

}  // namespace mbs::csc_mumps
