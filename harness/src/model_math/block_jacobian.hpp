// Square pieces of Phi_q as dense matrices, evaluated again and again.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "mbs/model.hpp"
#include "model_math/closed_parts.hpp"
#include "model_math/known_motion.hpp"
#include "model_math/vector3.hpp"

namespace mbs {

using SquareMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Phi_q of some rows and columns. A block with one column more than rows has a last row left to
/// its user. Allocates nothing after construction.
class BlockJacobian {
 public:
  /// `model` must outlive this.
  BlockJacobian(const Model& model, std::vector<ConstraintBlock> blocks);

  [[nodiscard]] std::size_t size() const { return blocks_.size(); }
  [[nodiscard]] const ConstraintBlock& block(std::size_t index) const { return blocks_[index]; }
  [[nodiscard]] static bool is_open(const ConstraintBlock& block) {
    return block.rows.size() < block.cols.size();
  }

  /// At q (n, m) and t (s); the rows that are left to the user stay as they are.
  void evaluate(double t, std::span<const double> q);
  /// As many rows as columns.
  [[nodiscard]] SquareMatrix& matrix(std::size_t index) { return matrices_[index]; }

 private:
  /// A quadratic row and the entries of `entries_` that it fills.
  struct Row {
    std::size_t matrix = 0, begin = 0, end = 0;
    std::array<int, 4> points{};  ///< a, b, c, d
    bool is_dot = true, is_distance = false;
    Matrix3 B{};
  };
  /// `factor` times an axis of the gradient at a - b or, 3 ... 5, at c - d is a part of it.
  struct Entry {
    std::size_t place = 0, axis = 0;
    double factor = 0.0;
  };

  template <class Constraint>
  void add_quadratic(std::size_t matrix, int row, const Constraint& constraint);
  [[nodiscard]] int col_of(std::size_t matrix, int coordinate) const;
  [[nodiscard]] Vector3 position(int point, std::span<const double> q) const;

  const Model& model_;
  KnownMotion known_;
  std::vector<ConstraintBlock> blocks_;
  std::vector<SquareMatrix> matrices_;
  std::vector<Row> rows_;
  std::vector<Entry> entries_;
};

}  // namespace mbs
