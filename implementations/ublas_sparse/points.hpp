// The points of a Model as one array of coordinates, free and fixed alike.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "matrices.hpp"
#include "mbs/model.hpp"

namespace mbs::ublas_sparse {

using Triple = std::array<double, 3>;  // planar: the third is zero

inline double dot(const Triple& x, const Triple& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/// Positions and velocities, q and v followed by the coordinates of the fixed points, so that no
/// term asks which kind its points are. A point is named by the place of its first coordinate.
///
/// Example, planar: A fixed at (0, 0), B free with offset 0, n = 2: B is 0, A is 2.
class Points {
 public:
  explicit Points(const Model& model);

  [[nodiscard]] int variables() const { return variables_; }
  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] int size() const { return static_cast<int>(position_.size()); }
  /// First coordinate of a point of Model::points().
  [[nodiscard]] int first(int point) const { return first_[point]; }
  [[nodiscard]] bool is_free(int first) const { return first < variables_; }

  [[nodiscard]] const double* position() const { return position_.data(); }  ///< m
  [[nodiscard]] const double* velocity() const { return velocity_.data(); }  ///< m/s
  /// x_a - x_b of an array x in the order of position().
  [[nodiscard]] Triple difference(const double* x, int a, int b) const {
    Triple result{};
    for (int k = 0; k < dimension_; ++k) result[k] = x[a + k] - x[b + k];
    return result;
  }

  /// Takes the coordinates q (n, m) of the free points.
  void move_to(std::span<const double> q) { std::ranges::copy(q, position_.begin()); }
  /// Takes their velocities v (n, m/s).
  void set_velocity(std::span<const double> v) { std::ranges::copy(v, velocity_.begin()); }
  /// Moves one coordinate of a fixed point: m, m/s.
  void drive(int coordinate, double position, double velocity) {
    position_[coordinate] = position;
    velocity_[coordinate] = velocity;
  }

 private:
  int variables_, dimension_;
  std::vector<int> first_;
  std::vector<double> position_;  // q, then fixed points
  std::vector<double> velocity_;  // v, then those of the fixed points: zero unless driven
};

}  // namespace mbs::ublas_sparse
