// Eqs. (7) and (8), row by row into the place of each.
#include "model_math/block_jacobian.hpp"

#include <algorithm>
#include <utility>

namespace mbs {

BlockJacobian::BlockJacobian(const Model& model, std::vector<ConstraintBlock> blocks)
    : model_(model), known_(model, 0.0), blocks_(std::move(blocks)) {
  for (const ConstraintBlock& block : blocks_) {
    const auto size = static_cast<Eigen::Index>(block.cols.size());
    matrices_.emplace_back(SquareMatrix::Zero(size, size));
  }
  const auto dots = static_cast<int>(model.dot_constraints().size());
  const int quadratic = dots + static_cast<int>(model.bilinear_constraints().size());
  for (std::size_t m = 0; m < blocks_.size(); ++m) {
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
          if (col >= 0) matrices_[m](place, col) = term.coefficient;
        }
      }
      ++place;
    }
  }
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
  added.points = {constraint.a, constraint.b, constraint.c, constraint.d};
  if constexpr (requires { constraint.B; }) {
    added.is_dot = false;
    added.B = constraint.B;
  }
  added.is_distance = added.is_dot && constraint.a == constraint.c && constraint.b == constraint.d;
  added.begin = entries_.size();
  for (std::size_t k = 0; k < (added.is_distance ? 2 : 4); ++k) {
    const Point& point = model_.points()[static_cast<std::size_t>(added.points[k])];
    if (point.is_fixed()) continue;
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    for (int axis = 0; axis < model_.dimension(); ++axis) {
      const int col = col_of(matrix, point.offset + axis);
      if (col < 0) continue;
      const auto place = row * matrices_[matrix].cols() + col;
      entries_.push_back({static_cast<std::size_t>(place),
                          static_cast<std::size_t>(axis) + (k < 2 ? 0 : 3),
                          added.is_distance ? 2 * sign : sign});
    }
  }
  added.end = entries_.size();
  rows_.push_back(added);
}

inline Vector3 BlockJacobian::position(int point, std::span<const double> q) const {
  const Point& place = model_.points()[static_cast<std::size_t>(point)];
  if (place.is_fixed()) return known_.position(point);
  const auto offset = static_cast<std::size_t>(place.offset);
  return {q[offset], q[offset + 1], model_.dimension() == 3 ? q[offset + 2] : 0.0};
}

void BlockJacobian::evaluate(double t, std::span<const double> q) {
  if (!model_.driven_points().empty()) known_.set_time(t);
  for (const Row& row : rows_) {
    const auto [a, b, c, d] = row.points;
    const Vector3 u = position(a, q) - position(b, q);
    const Vector3 w = row.is_distance ? u : position(c, q) - position(d, q);
    const Vector3 at_ab = row.is_dot ? w : multiply(row.B, w);
    const Vector3 at_cd = row.is_dot ? u : multiply_transposed(row.B, u);
    const std::array<double, 6> gradient{at_ab[0], at_ab[1], at_ab[2],
                                         at_cd[0], at_cd[1], at_cd[2]};
    const std::span entries(entries_.data() + row.begin, entries_.data() + row.end);
    double* const matrix = matrices_[row.matrix].data();
    for (const Entry& entry : entries) matrix[entry.place] = 0.0;
    for (const Entry& entry : entries) matrix[entry.place] += entry.factor * gradient[entry.axis];
  }
}

}  // namespace mbs
