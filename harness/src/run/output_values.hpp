// The quantities that a scene's author asked for, evaluated from states.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "run/scene_motion.hpp"

namespace mbs {

/// Scene::elements.outputs along a run; nothing else is computed.
///
/// Columns: NAME.x, NAME.y (in 3D NAME.z) of a position, NAME.vx ... of a velocity, NAME.ax ... of
/// an acceleration, NAME.x ... of the force on a point, NAME of anything else. Angles are those at
/// the start, in -pi ... pi, continued: they count turns, provided that follow() sees states less
/// than half a turn apart.
class OutputValues {
 public:
  /// `scene` must outlive this.
  explicit OutputValues(const Scene& scene);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }

  /// Takes the next state of the run; `state` must outlive values().
  void follow(double t, const State& state);

  /// One number a column at the state last taken: m, m/s, m/s^2, rad, J, N, N m.
  [[nodiscard]] std::vector<double> values() const;
  void values(std::span<double> result) const;

  /// Whether values() depend on the states that follow() has seen before.
  [[nodiscard]] bool has_angles() const { return has_angles_; }
  /// What follow() has made of the angles, one an output, to go on from a state in the past.
  [[nodiscard]] const std::vector<double>& angles() const { return angles_; }
  void set_angles(const std::vector<double>& angles) { angles_ = angles; }

 private:
  [[nodiscard]] Vector3 along(const Direction& direction) const;
  [[nodiscard]] double angle(const Output& output) const;
  [[nodiscard]] Vector3 vector(const Output& output) const;
  [[nodiscard]] double scalar(std::size_t index) const;

  const Scene& scene_;
  std::vector<std::string> columns_;
  SceneMotion motion_;
  const State* state_ = nullptr;
  std::vector<double> angles_;  // continued, one an output; 0 where it is no angle
  bool has_angles_ = false;
};

}  // namespace mbs
