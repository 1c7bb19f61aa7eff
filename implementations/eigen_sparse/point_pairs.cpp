// Set-up of pairs of points.
#include "point_pairs.hpp"

namespace mbs::eigen_sparse {

PointPairs::PointPairs(const Coordinates& coordinates, const std::array<int, 4>& points) {
  const auto [a, b, c, d] = points;
  for (const int point : free_ones(coordinates, points)) {
    weights[2 * free_points] = (point == a) - (point == b);
    weights[2 * free_points + 1] = (point == c) - (point == d);
    ++free_points;
  }
  int* end = ends;
  for (const int point : points) {
    for (int axis = 0; axis < coordinates.dimension(); ++axis) {
      *end++ = coordinates.of_point(point, axis);
    }
  }
}

Matrix packed(const std::array<std::array<double, 3>, 3>& matrix, int dimension) {
  Matrix result{};
  for (int i = 0; i < dimension; ++i) {
    for (int j = 0; j < dimension; ++j) result[dimension * i + j] = matrix[i][j];
  }
  return result;
}

}  // namespace mbs::eigen_sparse
