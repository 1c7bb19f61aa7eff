// The numbers of a program's fronts: block L D Lᵀ, fused with the substitution of a right-hand
// side.
#pragma once

#include <algorithm>

#include "panel_vectors.hpp"
#include "program.hpp"
#include "scalar.hpp"

namespace mbs::compiled_ldl {

/// Columns keep L D below their pivot: L is that times the inverse pivot.
template <typename F>
class Fronts {
 public:
  /// `definite`: only positive pivots are accepted.
  Fronts(const Program& program, bool definite);

  /// What every factorization begins with.
  F* constants() { return constants_.data(); }
  /// The matrix, valid from start() until factorize().
  F* matrix() { return matrix_.data(); }
  void start() { std::copy(constants_.begin(), constants_.end(), matrix_.begin()); }

  /// Factorizes and solves for y, which is padded; false if a pivot is not accepted.
  bool factorize_and_solve(F* y);
  void solve(F* y) const;
  /// Below zero in the lanes where a pivot was not accepted.
  [[nodiscard]] const F& least_pivot() const { return least_; }

 private:
  void factorize(const Front& front, F* y);
  void pivot_columns(const Front& front, F* columns, int j, int end, F* y);
  void update_column(const Front& front, const F* columns, int from, int to, F* target, int row);
  void update_border(const Front& front, F* y);
  void scatter(const Front& front, const Group& group, int k);
  void forward(const Front& front, F* y) const;
  void backward(const Front& front, F* y) const;
  void check(const F& inverse);

  const Program& program_;
  bool definite_;
  Array<F> constants_, matrix_;
  Array<F> inverse_;       // of the pivots
  mutable Array<F> work_;  // a column
  F least_ = 1.0;
};

}  // namespace mbs::compiled_ldl

#include "fronts_factorize.hpp"
#include "fronts_solve.hpp"
