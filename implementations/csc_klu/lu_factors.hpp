// KLU behind a small interface: analysis once, factors with new or with kept pivots, solve in
// place.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "storage.hpp"

namespace mbs::csc_klu {

/// What is known of a symmetric matrix before it is factorized.
struct Structure {
  enum class Kind {
    definite,    ///< positive definite
    indefinite,  ///< anything else, quasi-definite or not
  };
  Kind kind = Kind::definite;
  /// Row and column to eliminate first, second, ...; empty: AMD's order. Not needed later.
  std::span<const int> order = {};
};

/// LU factors of a symmetric matrix on one pattern, and the analysis that they need.
///
/// Factors are valid if every pivot is finite and not zero; pivots of a definite matrix have to be
/// positive too as long as all of them are on the diagonal, which is the test for definiteness.
/// Once there are pivots off the diagonal nothing is said about it. Indefinite matrices have pivots
/// of both signs. Those of quasi-definite ones are known beforehand, but a wrong one is a rounding
/// error, which rows that depend on each other allow and survive.
class LuFactors {
 public:
  /// Orders and analyses `pattern`, which has to outlive this. `pivot_tolerance`, 0 to 1: factor()
  /// takes the diagonal entry unless it is smaller than that part of the largest of its column.
  LuFactors(const Pattern& pattern, double pivot_tolerance, const Structure& structure);
  ~LuFactors();

  /// Chooses pivots for `values` (entries of the pattern) and factorizes; allocates. False if the
  /// factors are not valid: then there are none.
  [[nodiscard]] bool factor(std::span<const double> values);
  /// Factorizes with the pivots of the last factor(). False if there are none or the factors are
  /// not valid: then solve() must not be called before the next success, pivots stay.
  [[nodiscard]] bool refactor(std::span<const double> values);
  /// Replaces the right-hand side x (n) by the solution; by NaN if there are no factors.
  void solve(std::span<double> x);

  [[nodiscard]] bool exist() const;
  /// Pivots that the last factor() took off the diagonal.
  [[nodiscard]] int off_diagonal_pivots() const;

 private:
  struct Handles;
  std::unique_ptr<Handles> klu_;
};

/// Version of KLU as its header states it.
[[nodiscard]] std::string klu_version();

}  // namespace mbs::csc_klu
