// Where the points of a model are found: in extended vectors and among the coordinates.
#pragma once

#include <Eigen/Core>
#include <array>
#include <initializer_list>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::eigen_dense {

/// What a free point contributes to u = r_a − r_b and w = r_c − r_d: its factor there, −1, 0 or 1.
struct Share {
  Eigen::Index start = 0;  ///< first coordinate of the point
  double in_u = 0.0, in_w = 0.0;
};

/// The distinct free points among a, b, c, d in ascending order of their coordinates.
struct Shares {
  std::array<Share, 4> items{};
  int count = 0;

  [[nodiscard]] const Share* begin() const { return items.data(); }
  [[nodiscard]] const Share* end() const { return items.data() + count; }
  [[nodiscard]] bool empty() const { return count == 0; }
};

/// Fixed points are made readable like free ones: *extended* vectors have the n coordinates first,
/// then those of the fixed points (velocity 0 unless they are driven).
///
/// Example, planar, A fixed at (0, 0), B free: extended q = (x_B, y_B, 0, 0).
class Layout {
 public:
  using Index = Eigen::Index;

  explicit Layout(const Model& model);

  [[nodiscard]] Index variables() const { return variables_; }
  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] Index extended_size() const { return extended_size_; }
  /// Where the point starts in an extended vector; 0 for the axis of a planar model, −1.
  [[nodiscard]] Index start(int point) const { return point < 0 ? 0 : start_[point]; }
  /// Of the points a, b or a, b, c, d.
  [[nodiscard]] Shares shares(std::initializer_list<int> points) const;
  /// The model's q at t = 0, extended (m).
  [[nodiscard]] Eigen::VectorXd initial_position(const Model& model) const;

 private:
  Index variables_;
  int dimension_;
  Index extended_size_;
  std::vector<Index> start_;  ///< of each point
};

/// The components of r_a − r_b, points given by their starts in r.
template <int dimension, typename Scalar>
Eigen::Matrix<Scalar, dimension, 1> difference(const Scalar* r, Eigen::Index a, Eigen::Index b) {
  using Vector = Eigen::Matrix<Scalar, dimension, 1>;
  return Eigen::Map<const Vector>(r + a) - Eigen::Map<const Vector>(r + b);
}

}  // namespace mbs::eigen_dense
