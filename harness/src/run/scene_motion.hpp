// Where the points of a scene are, and how they move: free, fixed, driven, and points of bodies.
#pragma once

#include <vector>

#include "mbs/simulation.hpp"
#include "model_math/known_motion.hpp"
#include "model_math/vector3.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// Motion of the points at one instant after the other. Indices are those of Model::points(), then,
/// past its end, of Elements::markers. Planar: third components are 0.
///
///   SceneMotion motion(scene);
///   motion.set(t, state);
///   Vector3 r = motion.position(0);
class SceneMotion {
 public:
  /// `scene` must outlive this.
  explicit SceneMotion(const Scene& scene);

  /// `state` must outlive the questions that follow.
  void set(double t, const State& state);

  /// How many there are, markers included.
  [[nodiscard]] int points() const;
  [[nodiscard]] const std::string& name(int index) const;
  [[nodiscard]] Vector3 position(int index) const;      ///< m
  [[nodiscard]] Vector3 velocity(int index) const;      ///< m/s
  [[nodiscard]] Vector3 acceleration(int index) const;  ///< m/s^2

  /// Of all that moves, mass carried by driven points included, J.
  [[nodiscard]] double kinetic_energy() const;
  /// That of the model, of the constant forces on driven points, zero where they are at 0, and of
  /// springs whose stiffness is a function of time; J.
  [[nodiscard]] double potential_energy() const;

 private:
  template <class Known>
  [[nodiscard]] Vector3 motion(int index, const std::vector<double> State::*free,
                               Known known) const;

  const Scene& scene_;
  KnownMotion known_;
  double t_ = 0.0;  // s
  const State* state_ = nullptr;
};

}  // namespace mbs
