// The saddle-point matrix: values refreshed in place on a pattern made once.
#pragma once

#include <span>
#include <vector>

#include "constraints.hpp"
#include "coordinates.hpp"
#include "rank_update.hpp"
#include "solver.hpp"

namespace mbs::eigen_sparse {

/// What the upper left block holds: M, or M + (dt/2) C + (dt^2/4) K.
enum class Stiffness { none, added };

/// [T0, Phi_q^T; Phi_q, -epsilon] of Eqs. (12) and (14): n + m rows and columns, each multiplier
/// behind the unknowns of its row of Phi_q, or behind those that the row owns.
///
/// Example: unknowns 0, 1, 2 and a row of Phi_q with entries at 0 and 1 are stored in the order
/// 0, 1, multiplier, 2: unknowns() is 0, 1, 3 and multipliers() is 2.
class SaddleMatrix {
 public:
  /// Solver::saddle_order().
  using SaddleOrder = decltype(SimplicialSolver<double>::saddle_order)*;

  /// The values start with Phi_q of linear constraints alone.
  SaddleMatrix(const Model& model, const Coordinates& coordinates, const Constraints& constraints,
               Triangle triangle, double epsilon, Stiffness stiffness, SaddleOrder order,
               Tuning tuning);

  /// Takes Phi_q as it is in `jacobian`; C and K, if there are any, have to be added again.
  void refresh(const RowSparseMatrix& jacobian);

  [[nodiscard]] const SparseMatrix& matrix() const { return matrix_; }
  [[nodiscard]] double* values() { return matrix_.valuePtr(); }
  /// For what C and K add; without matrix if they do not.
  [[nodiscard]] Layout layout() const;
  /// Rows and columns of the unknowns (n) and of the multipliers (m).
  [[nodiscard]] std::span<const int> unknowns() const {
    return std::span(place_).first(variables_);
  }
  [[nodiscard]] std::span<const int> multipliers() const {
    return std::span(place_).subspan(variables_);
  }

 private:
  Triangle triangle_;
  std::size_t variables_;
  std::vector<int> place_;
  SparseMatrix matrix_;
  Vector base_;                // values without C, K and the rows that change; empty: no C and K
  std::vector<int> slots_;     // of the entries of Phi_q that change, in one half
  std::vector<int> mirrored_;  // and in the other, if that is stored
};

}  // namespace mbs::eigen_sparse
