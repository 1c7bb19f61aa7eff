// KLU behind a small interface: symbolic analysis once, numeric refactorization, solve in place.
#pragma once

#include <concepts>
#include <memory>
#include <span>
#include <string>

#include "assembly.hpp"

namespace mbs::csc_klu {

/// What the simulation asks of a solver; every variant is a simulation with another one.
template <class Solver>
concept TangentSolver = std::constructible_from<Solver, const Pattern&, std::span<const double>> &&
    requires(Solver solver, std::span<const double> values, std::span<double> x) {
  { solver.factorize(values) } -> std::same_as<bool>;
  solver.solve(x);
};

/// LU factors whose ordering and pivots stay as they were found at set-up.
class Refactorization {
 public:
  /// Orders and analyses `pattern`, which has to outlive this, and factorizes `values` on it.
  Refactorization(const Pattern& pattern, std::span<const double> values);
  ~Refactorization();

  /// Factorizes new values on the same pattern. False if the matrix is not positive definite or
  /// not finite; another call may succeed.
  [[nodiscard]] bool factorize(std::span<const double> values);
  /// Replaces the right-hand side x (n) by the solution with the factors of the last success.
  void solve(std::span<double> x);

 private:
  struct Handles;
  std::unique_ptr<Handles> klu_;
};

/// Version of KLU as its header states it.
[[nodiscard]] std::string klu_version();

}  // namespace mbs::csc_klu
