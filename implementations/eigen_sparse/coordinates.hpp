// Where the unknowns live: elimination order for the free coordinates, fixed points behind them.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::eigen_sparse {

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
  /// Coordinates of the fixed points, the tail of an extended position (m); driven ones at t = 0.
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

/// The points a, b, c, d of a constraint or torsion spring, a and b of a spring or couple.
template <class Item>
auto ends_of(const Item& item) {
  if constexpr (requires { item.c; }) {
    return std::array<int, 4>{item.a, item.b, item.c, item.d};
  } else {
    return std::array<int, 2>{item.a, item.b};
  }
}

/// Those of `points` that are free, each once, in their order.
std::vector<int> free_ones(const Coordinates& coordinates, std::span<const int> points);

/// Appends the unknowns of free_ones(): the columns of a row that depends on these points.
void append_columns(const Coordinates& coordinates, std::span<const int> points,
                    std::vector<int>& columns);

/// M: n x n, symmetric, both triangles, stored zeros included.
RowSparseMatrix mass_matrix(const Model& model, const Coordinates& coordinates);

/// M with a position for every entry of C and K, in the form of mass_matrix().
SparseMatrix stiffness_pattern(const Model& model, const Coordinates& coordinates);

/// M with a position for every entry of Phi_q^T Phi_q, C and K, Eq. (5): n x n, symmetric, both
/// triangles.
SparseMatrix tangent_pattern(const Model& model, const Coordinates& coordinates);

enum class Tuning;  // solver.hpp

/// The numbering of a model by `order`, which tells where each unknown of a tangent's pattern is
/// eliminated.
Coordinates numbered_by(const Model& model, std::vector<int> (*order)(const SparseMatrix&, Tuning),
                        Tuning tuning);

}  // namespace mbs::eigen_sparse
