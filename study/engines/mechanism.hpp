// The planar mechanisms that all engines model: rods in a tree of pin joints, loops closed by
// further pins.
#pragma once  // C++17, as Simbody's headers do not compile as C++20

#include <string>
#include <vector>

namespace engines {

constexpr double kGravity = 9.81;  // m/s^2, along -y

/// A thin uniform rod. It starts at its pin joint and ends `length` further along its direction.
struct Rod {
  int parent;           ///< the rod at whose end its pin is; -1: the ground, at `anchor`
  double anchor;        ///< x of a pin on the ground, m (y is 0)
  double length, mass;  ///< m, kg
  double angle, rate;   ///< of its direction from +x at the start, rad, rad/s

  /// About its centre, kg m^2. The engines are spatial: they get it about all three axes, as the
  /// other two never act and equal moments are the best conditioned.
  [[nodiscard]] double inertia() const { return mass * length * length / 12; }
};

/// The ends of two rods are pinned together.
struct Loop {
  int rod, other;
};

/// Rods come after their parents. A four-bar of N = 2 has the rods 0, 1, 2 on the ground, the
/// coupler 3 on rod 0 and 4 on rod 1, and the loops {3, 1}, {4, 2}.
struct Mechanism {
  std::string scene;           ///< what the harness calls it
  std::vector<Rod> rods = {};  ///< none: it is known to the harness alone
  std::vector<Loop> loops = {};
  int points = 0;          ///< the ends of so many first rods are compared with the known motion
  int four_bar_loops = 0;  ///< N of an N-four-bar, 0 of others
};

/// The N-four-bar mechanism of paper/README.md: a tree of depth two and a loop for each coupler.
Mechanism four_bar(int loops);
/// That of harness/scenes/double_pendulum.json, which study/engines/double_pendulum.json is too.
Mechanism double_pendulum();

/// Motion of a rod: its centre (m), the direction from its pin to its end, and velocities.
struct RodState {
  double x, y, cosine, sine;
  double vx, vy, rate;
};

/// States at the start.
std::vector<RodState> initial_states(const Mechanism& mechanism);

/// States of the rods from the coordinates of a tree of pins: a rod's angle and rate against its
/// parent's, the ground's being 0.
void states_of_joints(const Mechanism& mechanism, const std::vector<double>& angles,
                      const std::vector<double>& rates, std::vector<RodState>& states);

}  // namespace engines
