// The rigid motion that fits given positions or velocities best.
#pragma once

#include <optional>
#include <vector>

#include "model_math/vector3.hpp"

namespace mbs {

/// Global place = origin + R local; of a vector R local.
struct Pose {
  Vector3 origin{};
  Matrix3 R{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

  [[nodiscard]] Vector3 place(const Vector3& local, bool is_vector) const {
    const Vector3 turned = multiply(R, local);
    return is_vector ? turned : origin + turned;
  }
};

/// Rotation by |rotation| (rad) about its direction.
Matrix3 rotation_matrix(const Vector3& rotation);

/// One thing that a pose or motion is fitted to.
struct Sighting {
  Vector3 local{};   ///< fit_pose: in local axes; fit_twist: the global position
  Vector3 global{};  ///< fit_pose: the global position; fit_twist: the velocity
  bool is_vector = false;
  bool is_exact = false;  ///< a fixed vector: where two say the rotation, no other is asked
};

/// The least-squares pose (vectors weigh like points at `size` from the middle), or nothing if the
/// sightings leave it open: no point, or too few directions among them (one in the plane, two in
/// space).
std::optional<Pose> fit_pose(const std::vector<Sighting>& sightings, int dimension, double size);

/// Velocity of a body: v(r) = velocity + spin x (r - at).
struct Twist {
  Vector3 at{}, velocity{}, spin{};

  [[nodiscard]] Vector3 of_point(const Vector3& r) const { return velocity + cross(spin, r - at); }
};

/// The least-squares motion with these velocities of points and vectors, or nothing if they leave
/// it open.
std::optional<Twist> fit_twist(const std::vector<Sighting>& sightings, int dimension);

}  // namespace mbs
