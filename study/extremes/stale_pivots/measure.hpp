// Backward errors, re-pivotings and times of every strategy on a sequence of matrices.
#pragma once

#include <string>
#include <vector>

#include "sequences.hpp"

namespace mbs::stale_pivots {

/// One strategy on one sequence. Pivots are those of the first matrix until the strategy changes
/// them: "refactor" never does, "guarded" when a solution is too wrong, "factor" always.
struct Row {
  std::string sequence, form;
  std::string strategy;
  int matrices = 0;      ///< as many solves
  std::string pivoting;  ///< the rule by which pivots are chosen: "diagonal", "default", "largest"
  /// max|b - A x| / max(|A| |x| + |b|) of a solution; 1, as x = 0 has, where there is none.
  double error_median = 0.0, error_worst = 0.0;
  int repivotings = 0;          ///< after the first matrix
  double time_us_median = 0.0;  ///< factorize and solve
};

/// Strategies take turns at every matrix, so that disturbances hit all. The whole sequence is run
/// `rounds` times, from new solvers, for the times.
[[nodiscard]] std::vector<Row> measure(const Sequence& sequence, int rounds);

}  // namespace mbs::stale_pivots
