// Eqs. (7) and (8), row by row into the place of each.
#include "model_math/block_jacobian.hpp"

#include <algorithm>
#include <utility>

namespace mbs {

BlockJacobian::BlockJacobian(const Model& model, std::vector<ConstraintBlock> blocks)
    : model_(model), known_(model, 0.0), blocks_(std::move(blocks)) {
  const auto dots = static_cast<int>(model.dot_constraints().size());
  const int quadratic = dots + static_cast<int>(model.bilinear_constraints().size());
  for (std::size_t m = 0; m < blocks_.size(); ++m) {
    const auto size = static_cast<Eigen::Index>(blocks_[m].cols.size());
    constant_.emplace_back(SquareMatrix::Zero(size, size));
    int place = 0;
    for (const int row : blocks_[m].rows) {
      if (row < dots) {
        add_quadratic(m, place, model.dot_constraints()[static_cast<std::size_t>(row)]);
      } else if (row < quadratic) {
        add_quadratic(m, place, model.bilinear_constraints()[static_cast<std::size_t>(row - dots)]);
      } else {
        for (const auto& term :
             model.linear_constraints()[static_cast<std::size_t>(row - quadratic)].terms) {
          const int col = col_of(m, term.coordinate);
          if (col >= 0) constant_[m](place, col) = term.coefficient;
        }
      }
      ++place;
    }
  }
  matrices_ = constant_;
}

int BlockJacobian::col_of(std::size_t matrix, int coordinate) const {
  const auto& cols = blocks_[matrix].cols;
  const auto found = std::ranges::lower_bound(cols, coordinate);
  return found == cols.end() || *found != coordinate ? -1 : static_cast<int>(found - cols.begin());
}

template <class Constraint>
void BlockJacobian::add_quadratic(std::size_t matrix, int row, const Constraint& constraint) {
  Row added;
  added.matrix = matrix;
  added.row = row;
  added.points = {constraint.a, constraint.b, constraint.c, constraint.d};
  for (std::size_t k = 0; k < added.points.size(); ++k) {
    const Point& point = model_.points()[static_cast<std::size_t>(added.points[k])];
    added.cols[k] = {-1, -1, -1};
    if (point.is_fixed()) continue;
    for (int axis = 0; axis < model_.dimension(); ++axis) {
      added.cols[k][static_cast<std::size_t>(axis)] = col_of(matrix, point.offset + axis);
    }
  }
  if constexpr (requires { constraint.B; }) {
    added.is_dot = false;
    added.B = constraint.B;
  }
  rows_.push_back(added);
}

Vector3 BlockJacobian::position(int point, std::span<const double> q) const {
  const Point& place = model_.points()[static_cast<std::size_t>(point)];
  if (place.is_fixed()) return known_.position(point);
  const auto offset = static_cast<std::size_t>(place.offset);
  return {q[offset], q[offset + 1], model_.dimension() == 3 ? q[offset + 2] : 0.0};
}

void BlockJacobian::evaluate(double t, std::span<const double> q) {
  if (!model_.driven_points().empty()) known_.set_time(t);
  for (std::size_t m = 0; m < matrices_.size(); ++m) matrices_[m] = constant_[m];
  for (const Row& row : rows_) {
    const Vector3 u = position(row.points[0], q) - position(row.points[1], q);
    const Vector3 w = position(row.points[2], q) - position(row.points[3], q);
    const Vector3 at_ab = row.is_dot ? w : multiply(row.B, w);
    const Vector3 at_cd = row.is_dot ? u : multiply_transposed(row.B, u);
    SquareMatrix& matrix = matrices_[row.matrix];
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector3& gradient = k < 2 ? at_ab : at_cd;
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int col = row.cols[k][axis];
        if (col >= 0) matrix(row.row, col) += sign * gradient[axis];
      }
    }
  }
}

}  // namespace mbs
