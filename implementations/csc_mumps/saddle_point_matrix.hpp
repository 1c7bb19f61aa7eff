// The matrix of the saddle-point form, Eq. (12).
#pragma once

#include <span>
#include <vector>

#include "assembly.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "pattern.hpp"
#include "solver.hpp"

namespace mbs::csc_mumps {

/// Its lower triangle, block after block: T0 by columns, Phi_q by columns, the diagonal of
/// -epsilon. MUMPS takes entries in any order, so that nothing is woven together.
class SaddlePointMatrix {
 public:
  /// `assembly` is that of `model` and outlives this.
  SaddlePointMatrix(const Model& model, const Assembly& assembly, const StepSettings& settings);

  [[nodiscard]] Triplets pattern() const;
  /// One an entry of the pattern; never moves.
  [[nodiscard]] std::span<double> values() { return values_; }
  /// When each variable should be eliminated, from 1: coordinates in an order of minimum degree (or
  /// as tuned) for T0 + Phi_q' Phi_q, each multiplier right after the last of its coordinates, or
  /// after the one that it owns (README.md). `model` is that of the constructor.
  [[nodiscard]] std::vector<int> elimination_order(const Model& model, Tuning tuning) const;

  /// The values, for the Phi_q and forces evaluated last. False if there is a NaN or an infinity.
  [[nodiscard]] bool evaluate();

 private:
  const Assembly& assembly_;
  const int variables_, constraints_;
  ColumnPattern inertia_pattern_;  // of T0: the union of those of M and K
  std::vector<double> mass_;       // on it
  std::vector<int> force_places_;  // on it, of the forces' entries
  std::vector<double> values_;
};

}  // namespace mbs::csc_mumps
