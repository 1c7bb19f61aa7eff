// How soon a torsion spring or torque law may have turned so far that whole turns get lost.
#pragma once

#include <vector>

#include "run/scene_motion.hpp"

namespace mbs {

/// Time in which something of this speed and acceleration goes `way`: the smaller root of
/// acceleration t^2/2 + speed t = way.
double time_to_go(double way, double speed, double acceleration);

/// The torsions that may not turn on (Torsion::can_turn_on). Who looks at them no later than time()
/// after a look sees each whole turn.
class QuarterTurn {
 public:
  /// `scene` must outlive this.
  explicit QuarterTurn(const Scene& scene);

  [[nodiscard]] bool is_needed() const { return !corners_.empty(); }
  /// What the first of them takes for a quarter of a turn, at its rate and acceleration now, s.
  [[nodiscard]] double time(double t, const State& state);

 private:
  struct Corner {
    int a = 0, b = 0, c = 0, d = 0, axis = -1;  // as TorsionSpring
  };
  std::vector<Corner> corners_;
  SceneMotion motion_;
};

}  // namespace mbs
