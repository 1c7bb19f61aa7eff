// Where the unknowns live: elimination order for the free coordinates, fixed points behind them.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::eigen_superlu {

using Vector = Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;  // by columns
using RowSparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Numbers the unknowns as the solver eliminates them. "Extended" vectors have n entries for the
/// unknowns and then one for every coordinate of a fixed point, so that no loop asks which is
/// which.
///
/// Example, planar: A fixed, B and C free, C eliminated first: C is 0, 1; B is 2, 3; A is 4, 5.
class Coordinates {
 public:
  /// `position` (n) is a permutation: unknown i of the model becomes unknown position[i].
  Coordinates(const Model& model, std::vector<int> position);

  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] int variables() const { return static_cast<int>(position_.size()); }
  [[nodiscard]] int extended() const { return variables() + static_cast<int>(fixed_.size()); }

  /// Where unknown `i` of the model is.
  [[nodiscard]] int of_unknown(int i) const { return position_[i]; }
  /// Where coordinate `axis` of `point` is in an extended vector.
  [[nodiscard]] int of_point(int point, int axis) const {
    return points_[point * dimension_ + axis];
  }
  [[nodiscard]] bool is_free(int point) const { return of_point(point, 0) < variables(); }
  /// Coordinates of the fixed points, the tail of an extended position (m).
  [[nodiscard]] const std::vector<double>& fixed() const { return fixed_; }

  /// Copies `source` (n, order of the model) into the first n entries of `target`.
  void gather(const std::vector<double>& source, Vector& target) const;
  /// Copies the first n entries of `source` into `target` (n, order of the model).
  void scatter(const Vector& source, std::vector<double>& target) const;

 private:
  int dimension_;
  std::vector<int> position_;
  std::vector<int> points_;
  std::vector<double> fixed_;
};

/// The unknowns that a dot constraint couples: all coordinates of its free points, points once.
std::vector<int> free_points(const Coordinates& coordinates, const DotConstraint& constraint);

/// M: n x n, symmetric, both triangles, stored zeros included.
RowSparseMatrix mass_matrix(const Model& model, const Coordinates& coordinates);

/// M with a position for every entry of Phi_q^T Phi_q, Eq. (5): n x n, symmetric, both triangles.
SparseMatrix tangent_pattern(const Model& model, const Coordinates& coordinates);

}  // namespace mbs::eigen_superlu
