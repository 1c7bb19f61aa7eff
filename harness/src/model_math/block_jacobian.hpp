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

  /// At q (n, m) and t (s); the rows that are left to the user become 0.
  void evaluate(double t, std::span<const double> q);
  /// As many rows as columns.
  [[nodiscard]] SquareMatrix& matrix(std::size_t index) { return matrices_[index]; }

 private:
  /// A quadratic row: where the gradient at its points goes.
  struct Row {
    std::size_t matrix = 0;
    int row = 0;
    std::array<int, 4> points{};               ///< a, b, c, d
    std::array<std::array<int, 3>, 4> cols{};  ///< of each point and axis; -1: not in the block
    bool is_dot = true;
    Matrix3 B{};
  };

  template <class Constraint>
  void add_quadratic(std::size_t matrix, int row, const Constraint& constraint);
  [[nodiscard]] int col_of(std::size_t matrix, int coordinate) const;
  [[nodiscard]] Vector3 position(int point, std::span<const double> q) const;

  const Model& model_;
  KnownMotion known_;
  std::vector<ConstraintBlock> blocks_;
  std::vector<SquareMatrix> constant_, matrices_;  // constant_: linear rows alone
  std::vector<Row> rows_;
};

}  // namespace mbs
