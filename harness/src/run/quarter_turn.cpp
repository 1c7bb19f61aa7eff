// The angle from u to w about z turns at z . (w x w') / w . w less the same of u.
#include "run/quarter_turn.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace mbs {

double time_to_go(double way, double speed, double acceleration) {
  return 2 * way / (speed + std::sqrt(speed * speed + 2 * acceleration * way) + 1e-300);
}

QuarterTurn::QuarterTurn(const Scene& scene) : motion_(scene) {
  for (const TorsionSpring& s : scene.model.torsion_springs()) {
    if (s.stiffness != 0.0) corners_.push_back({s.a, s.b, s.c, s.d, s.axis});
  }
  for (const TorqueLaw& law : scene.model.torque_laws()) {
    if (!law.law.by_position.is_zero()) corners_.push_back({law.a, law.b, law.c, law.d, law.axis});
  }
}

double QuarterTurn::time(double t, const State& state) {
  motion_.set(t, state);
  double least = std::numeric_limits<double>::infinity();
  for (const Corner& it : corners_) {
    const Vector3 z = it.axis < 0 ? Vector3{0.0, 0.0, 1.0} : motion_.position(it.axis);
    const Vector3 u = motion_.position(it.a) - motion_.position(it.b);
    const Vector3 w = motion_.position(it.c) - motion_.position(it.d);
    const auto turn = [&](Vector3 (SceneMotion::*of)(int) const) {
      const Vector3 at_u = (motion_.*of)(it.a) - (motion_.*of)(it.b);
      const Vector3 at_w = (motion_.*of)(it.c) - (motion_.*of)(it.d);
      return std::abs(dot(z, cross(w, at_w)) / dot(w, w) - dot(z, cross(u, at_u)) / dot(u, u));
    };
    least = std::min(least, time_to_go(std::numbers::pi / 2, turn(&SceneMotion::velocity),
                                       turn(&SceneMotion::acceleration)));
  }
  return least;
}

}  // namespace mbs
