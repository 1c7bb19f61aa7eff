// The immutable multibody model: what a scene requires, in natural coordinates, and nothing else.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace mbs {

/// A point of the scene. A free point owns `dimension` consecutive entries of q, starting at
/// `offset`; a fixed point is a constant and owns none.
///
/// Example, planar: A fixed at (0, 0), B and C free, gives A.offset = -1, B.offset = 0 (q[0], q[1])
/// and C.offset = 2 (q[2], q[3]).
struct Point {
  std::string name;
  int offset = -1;                   ///< first coordinate in q, or -1 for a fixed point
  std::array<double, 3> position{};  ///< m; constant if fixed, at t = 0 if free (planar: z unused)

  [[nodiscard]] bool is_fixed() const { return offset < 0; }
};

/// Quadratic constraint on differences of points, Phi = (r_a - r_b) . (r_c - r_d) - value  (m^2).
/// A distance is a = c, b = d, value = length^2. Never expand the squares: that loses digits when
/// coordinates are large.
struct DotConstraint {
  int a = 0, b = 0, c = 0, d = 0;  ///< indices into Model::points()
  double value = 0.0;              ///< m^2
  std::string name;                ///< for messages
};

/// Linear constraint Phi = sum_k coefficient_k q[coordinate_k] - value  (m).
struct LinearConstraint {
  struct Term {
    int coordinate = 0;  ///< index into q
    double coefficient = 0.0;
  };
  std::vector<Term> terms;  ///< coordinates are distinct
  double value = 0.0;       ///< m
  std::string name;
};

/// One stored entry of the lower triangle of the symmetric mass matrix M. Entries of value zero are
/// stored positions too (artificial fill): sparse storage must hold and process them like any
/// other.
struct MassEntry {
  int row = 0, col = 0;  ///< row >= col
  double value = 0.0;    ///< kg
};

/// Everything a Model is made from; plain data, filled by whoever builds a scene.
struct ModelData {
  int dimension = 2;          ///< 2 or 3
  std::vector<Point> points;  ///< free points tile q in any order
  std::vector<DotConstraint> dot_constraints;
  std::vector<LinearConstraint> linear_constraints;
  std::vector<MassEntry> mass;           ///< any order; at most one entry a position
  std::vector<double> force;             ///< n, N; the constant applied force Q (gravity)
  std::vector<double> initial_velocity;  ///< n, m/s
};

/// The model that an implementation simulates. Immutable and checked at construction:
/// sizes and indices fit, all numbers are finite.
///
/// With n = variables() and m = constraints():
///   Phi (m) lists the dot constraints first, then the linear ones, in the order given;
///   M (n x n) is symmetric positive definite and constant;
///   Q (n) is constant.
class Model {
 public:
  /// Throws std::invalid_argument with the offending item if `data` is inconsistent.
  explicit Model(ModelData data);

  [[nodiscard]] int dimension() const { return data_.dimension; }
  [[nodiscard]] int variables() const { return variables_; }
  [[nodiscard]] int constraints() const {
    return static_cast<int>(data_.dot_constraints.size() + data_.linear_constraints.size());
  }

  [[nodiscard]] std::span<const Point> points() const { return data_.points; }
  [[nodiscard]] std::span<const DotConstraint> dot_constraints() const {
    return data_.dot_constraints;
  }
  [[nodiscard]] std::span<const LinearConstraint> linear_constraints() const {
    return data_.linear_constraints;
  }
  /// Lower triangle of M, sorted by column then row, each position once, every diagonal present.
  [[nodiscard]] std::span<const MassEntry> mass() const { return data_.mass; }
  [[nodiscard]] std::span<const double> force() const { return data_.force; }
  /// Coordinates of the free points at t = 0 (n, m).
  [[nodiscard]] std::span<const double> initial_position() const { return initial_position_; }
  [[nodiscard]] std::span<const double> initial_velocity() const { return data_.initial_velocity; }

 private:
  ModelData data_;
  int variables_ = 0;
  std::vector<double> initial_position_;
};

}  // namespace mbs
