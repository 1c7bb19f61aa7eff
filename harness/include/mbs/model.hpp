// The immutable multibody model: what a scene requires, in natural coordinates, and nothing else.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "mbs/curve.hpp"
#include "mbs/time_function.hpp"

namespace mbs {

/// A point of the scene, or a unit vector: for the equations both are `dimension` numbers. A free
/// point owns as many consecutive entries of q, starting at `offset`; a fixed point owns none: it
/// is a constant, or a known function of time where Model::driven_points() names it.
///
/// Example, planar: A fixed at (0, 0), B and C free, gives A.offset = -1, B.offset = 0 (q[0], q[1])
/// and C.offset = 2 (q[2], q[3]).
struct Point {
  std::string name;
  int offset = -1;  ///< first coordinate in q, or -1 for a fixed point
  std::array<double, 3>
      position{};          ///< m; constant if fixed, at t = 0 otherwise (planar: z unused)
  bool is_vector = false;  ///< a unit vector, dimensionless; the equations do not care

  [[nodiscard]] bool is_fixed() const { return offset < 0; }
};

/// Motion prescribed for a fixed point.
struct DrivenPoint {
  int point = 0;  ///< index into Model::points() of a fixed point, at most once
  std::array<TimeFunction, 3> position;  ///< m, one an axis (planar: the third unused)
};

/// Quadratic constraint on differences of points, Phi = (r_a - r_b) . (r_c - r_d) - value  (m^2).
/// A distance is a = c, b = d, value = length^2. Never expand the squares: that loses digits when
/// coordinates are large.
struct DotConstraint {
  int a = 0, b = 0, c = 0, d = 0;  ///< indices into Model::points()
  double value = 0.0;              ///< m^2
  std::string name;                ///< for messages

  [[nodiscard]] bool is_distance() const { return a == c && b == d; }
};

/// Quadratic constraint Phi = (r_a - r_b) . B (r_c - r_d) - value  (m^2) with a constant matrix B.
/// Planar, B = [0, 1; -1, 0] makes it the cross product, which keeps two directions parallel.
struct BilinearConstraint {
  int a = 0, b = 0, c = 0, d = 0;            ///< indices into Model::points()
  std::array<std::array<double, 3>, 3> B{};  ///< B[row][column]; planar: the upper left 2 x 2
  double value = 0.0;                        ///< m^2
  std::string name;
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

/// A constraint whose `value` is a known function of time.
struct DrivenValue {
  int constraint = 0;  ///< index into Phi, at most once
  TimeFunction value;  ///< takes the place of the constraint's own
};

/// Spring and damper along the line between two points. With d = r_a - r_b, L = |d|, e = d / L: the
/// force -(stiffness (L - length) + damping L') e acts on a, its opposite on b.
struct Spring {
  int a = 0, b = 0;        ///< indices into Model::points(), different
  double stiffness = 0.0;  ///< N/m, >= 0
  double damping = 0.0;    ///< N s/m, >= 0
  double length = 0.0;     ///< m, without force
  std::string name;
};

/// Spring and damper on the angle theta from u = r_a - r_b to w = r_c - r_d, counter-clockwise seen
/// against the axis z, which u and w are perpendicular to (planar: z = (0, 0, 1)):
/// theta = atan2(z . (u x w), u . w). The torque -(stiffness s + damping theta') acts on w, its
/// opposite on u, with s = theta - angle brought into -pi ... pi.
struct TorsionSpring {
  int a = 0, b = 0, c = 0, d = 0;  ///< indices into Model::points()
  int axis = -1;                   ///< 3D: index of the unit vector z; planar: -1
  double stiffness = 0.0;          ///< N m/rad, >= 0
  double damping = 0.0;            ///< N m s/rad, >= 0
  double angle = 0.0;              ///< rad, without torque
  std::string name;
};

/// How the force of an element depends on its length or angle s and on the rate s' of that:
/// F = factor(t) (by_position(s) + by_rate(s')), Eq. (18).
struct Law {
  Curve by_position = {};     ///< N over m, or N m over rad
  Curve by_rate = {};         ///< N over m/s, or N m over rad/s
  TimeFunction factor = 1.0;  ///< dimensionless; only its value enters
};

/// A law along the line between two points, s = L and e as of a Spring: the force -F e acts on a,
/// its opposite on b. F > 0 pulls them together.
struct ForceLaw {
  int a = 0, b = 0;  ///< indices into Model::points(), different
  Law law;
  std::string name;
};

/// A law about the axis z, s = theta in -pi ... pi as of a TorsionSpring: the torque -F acts on w,
/// its opposite on u.
struct TorqueLaw {
  int a = 0, b = 0, c = 0, d = 0;  ///< indices into Model::points()
  int axis = -1;                   ///< 3D: index of the unit vector z; planar: -1
  Law law;
  std::string name;
};

/// A constant torque about z on the direction w = r_a - r_b, which is perpendicular to z (planar:
/// z = (0, 0, 1)): the force torque (z x w) / (w . w) acts on a, its opposite on b.
struct Couple {
  int a = 0, b = 0;     ///< indices into Model::points(), different
  int axis = -1;        ///< 3D: index of the unit vector z; planar: -1
  double torque = 0.0;  ///< N m, counter-clockwise seen against z
  std::string name;
};

/// What the mass matrix has between a coordinate and a driven point: it puts
/// -value * (acceleration of the point along `axis`) into Q at that coordinate.
struct DrivenMass {
  int coordinate = 0;  ///< index into q
  int point = 0;       ///< index into Model::points() of a driven point
  int axis = 0;        ///< 0, 1 or (3D) 2
  double value = 0.0;  ///< kg
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
  std::vector<BilinearConstraint> bilinear_constraints = {};
  std::vector<LinearConstraint> linear_constraints;
  std::vector<MassEntry> mass;           ///< any order; at most one entry a position
  std::vector<double> force;             ///< n, N; the constant part of Q (gravity)
  std::vector<double> initial_velocity;  ///< n, m/s
  std::vector<Spring> springs = {};
  std::vector<TorsionSpring> torsion_springs = {};
  std::vector<Couple> couples = {};
  std::vector<ForceLaw> force_laws = {};
  std::vector<TorqueLaw> torque_laws = {};
  std::vector<DrivenPoint> driven_points = {};
  std::vector<DrivenValue> driven_values = {};
  std::vector<DrivenMass> driven_mass = {};
};

/// The model that an implementation simulates. Immutable and checked at construction:
/// sizes and indices fit, all numbers are finite.
///
/// With n = variables() and m = constraints():
///   Phi (m) lists the dot constraints first, then the bilinear, then the linear ones, in the order
///   given;
///   M (n x n) is symmetric positive definite and constant;
///   Q (n) is force() plus what springs, laws, couples and driven mass give.
/// A list is empty if the scene has no such thing.
class Model {
 public:
  /// Throws std::invalid_argument with the offending item if `data` is inconsistent.
  explicit Model(ModelData data);

  [[nodiscard]] int dimension() const { return data_.dimension; }
  [[nodiscard]] int variables() const { return variables_; }
  [[nodiscard]] int constraints() const {
    return static_cast<int>(data_.dot_constraints.size() + data_.bilinear_constraints.size() +
                            data_.linear_constraints.size());
  }

  [[nodiscard]] std::span<const Point> points() const { return data_.points; }
  [[nodiscard]] std::span<const DotConstraint> dot_constraints() const {
    return data_.dot_constraints;
  }
  [[nodiscard]] std::span<const BilinearConstraint> bilinear_constraints() const {
    return data_.bilinear_constraints;
  }
  [[nodiscard]] std::span<const LinearConstraint> linear_constraints() const {
    return data_.linear_constraints;
  }
  [[nodiscard]] std::span<const Spring> springs() const { return data_.springs; }
  [[nodiscard]] std::span<const TorsionSpring> torsion_springs() const {
    return data_.torsion_springs;
  }
  [[nodiscard]] std::span<const Couple> couples() const { return data_.couples; }
  [[nodiscard]] std::span<const ForceLaw> force_laws() const { return data_.force_laws; }
  [[nodiscard]] std::span<const TorqueLaw> torque_laws() const { return data_.torque_laws; }
  [[nodiscard]] std::span<const DrivenPoint> driven_points() const { return data_.driven_points; }
  [[nodiscard]] std::span<const DrivenValue> driven_values() const { return data_.driven_values; }
  [[nodiscard]] std::span<const DrivenMass> driven_mass() const { return data_.driven_mass; }
  /// Lower triangle of M, sorted by column then row, each position once, every diagonal present.
  [[nodiscard]] std::span<const MassEntry> mass() const { return data_.mass; }
  [[nodiscard]] std::span<const double> force() const { return data_.force; }
  /// Coordinates of the free points at t = 0 (n, m).
  [[nodiscard]] std::span<const double> initial_position() const { return initial_position_; }
  [[nodiscard]] std::span<const double> initial_velocity() const { return data_.initial_velocity; }
  /// What it was made from, for making another one like it.
  [[nodiscard]] const ModelData& data() const { return data_; }

 private:
  ModelData data_;
  int variables_ = 0;
  std::vector<double> initial_position_;
};

}  // namespace mbs
