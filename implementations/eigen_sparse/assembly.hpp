// The tangent matrix of the penalty form: values refreshed in place on a pattern made once.
#pragma once

#include <vector>

#include "constraints.hpp"
#include "coordinates.hpp"
#include "rank_update.hpp"
#include "solver.hpp"

namespace mbs::eigen_sparse {

/// T of Eq. (5), without what forces add to it.
class Tangent {
 public:
  /// `penalty` is (dt^2/4) alpha of Eq. (5). The values start as M plus what the linear
  /// constraints add, which is positive definite, with the final pattern.
  Tangent(const Model& model, const Coordinates& coordinates, const Constraints& constraints,
          Triangle triangle, double penalty);

  /// The values of Eq. (5) without C and K from Phi_q as it is in `jacobian`.
  void refresh(const RowSparseMatrix& jacobian);

  [[nodiscard]] const SparseMatrix& matrix() const { return matrix_; }
  [[nodiscard]] double* values() { return matrix_.valuePtr(); }
  [[nodiscard]] Layout layout() const { return {&matrix_, triangle_, {}}; }

 private:
  /// Consecutive rows of Phi_q of equal width.
  struct Run {
    AddRows add;
    int first_value, first_slot, count;
  };

  void make_runs(const Constraints& constraints);
  void add_linear_rows(const Constraints& constraints);

  Triangle triangle_;
  double penalty_;
  SparseMatrix matrix_;
  Vector base_;  // values that stay
  std::vector<int> slots_;
  std::vector<Run> runs_;
};

}  // namespace mbs::eigen_sparse
