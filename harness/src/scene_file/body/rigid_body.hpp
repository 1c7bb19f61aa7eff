// A rigid body's mass, in coordinates of any of its points and vectors: pure algebra.
//
// The place of a body is linear in a few of its points and vectors, its basis. With homogeneous
// local coordinates h = (1, p) of a point and (0, u) of a vector and X = [h_1, h_2, ...] of the
// basis, the point p is at r = sum w_k r_k with w = X^-1 h. In space h has four real numbers and
// the basis four members; in the plane p is a complex number, h has two and the basis two points,
// for turning is multiplying. Either way, with P the integral of h h^H over the mass, 2 T = sum
// r_i' M_ij r_j' has
//
//   M = conj(X^-1 P X^-H),   P = [m, m c^H; m c, m c c^H + S],
//
// S = tr(J)/2 I - J in space, J in the plane [Garcia de Jalon, Bayo: Kinematic and Dynamic
// Simulation of Multibody Systems, 1994, chapter 4].
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <vector>

#include "model_math/vector3.hpp"

namespace mbs {

/// Of a body, about its centre of mass, in local axes.
struct Inertia {
  double mass = 0.0;  ///< kg, > 0
  Vector3 centre{};   ///< m
  Matrix3 tensor{};   ///< kg m^2; planar: [2][2] alone
};

/// Something on the body: a point, or a vector (space only).
struct BodyPlace {
  Vector3 local{};
  bool is_vector = false;
};

/// Whether the tensor belongs to a body of extent along all axes: S is positive definite (with some
/// room for rounding), which is the triangle inequality. Planar: the inertia is above 0.
bool is_inertia(const Inertia& inertia, int dimension);

/// sqrt of the largest eigenvalue of S / m, m: how far the mass lies from the centre.
double radius_of_gyration(const Inertia& inertia, int dimension);

/// The same body with a point mass (kg) fixed to it.
Inertia with_point_mass(const Inertia& inertia, const Vector3& local, double mass, int dimension);

class BodyMass {
 public:
  using Weight = std::complex<double>;  ///< real in space
  using Weights = std::vector<Weight>;

  /// `basis` holds 2 (planar) or 4 (at least one of them a point) places in general position,
  /// `further` any number of others that get a share of the mass, so that M over both is positive
  /// definite: half of what P allows goes to them, in equal parts. `size` (m) scales the algebra.
  BodyMass(const Inertia& inertia, int dimension, double size, const std::vector<BodyPlace>& basis,
           const std::vector<BodyPlace>& further);

  /// w of a place, one a member of the basis; what rounding left of a zero is zero.
  [[nodiscard]] Weights weights(const BodyPlace& place) const;

  /// M between members i and j of the basis, and between further place k and itself; all else is 0.
  [[nodiscard]] Weight mass(std::size_t i, std::size_t j) const;
  [[nodiscard]] double share(std::size_t k) const { return shares_[k]; }

  /// Factors of g in Q at member i of the basis and at further place k.
  [[nodiscard]] Weight weighing(std::size_t i) const;
  [[nodiscard]] double weighing_further(std::size_t k) const;

 private:
  using Matrix = Eigen::Matrix<Weight, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 4, 4>;
  using Column = Eigen::Matrix<Weight, Eigen::Dynamic, 1, Eigen::ColMajor, 4, 1>;

  [[nodiscard]] Column homogeneous(const BodyPlace& place) const;
  [[nodiscard]] Matrix pseudo_inertia(const Inertia& inertia) const;

  int dimension_;
  double size_;
  Vector3 origin_;  // the centre of mass: P is best conditioned there
  std::vector<BodyPlace> basis_, further_;
  Matrix inverse_;  // X^-1
  Matrix mass_;     // M of the basis
  Column weighing_;
  std::vector<double> shares_;
};

/// The real matrix of a weight, as it multiplies a position: w I in space, [a, -b; b, a] in the
/// plane.
Matrix3 block_of(BodyMass::Weight weight, int dimension);

}  // namespace mbs
