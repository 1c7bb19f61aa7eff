// The two mechanisms, and their kinematics as trees.
#include "mechanism.hpp"

#include <cmath>
#include <numbers>

namespace engines {

Mechanism four_bar(int loops) {
  Mechanism made{.scene = "four-bar:" + std::to_string(loops),
                 .rods = {},
                 .loops = {},
                 .points = loops + 1,
                 .four_bar_loops = loops};
  for (int i = 0; i <= loops; ++i) {
    made.rods.push_back({-1, static_cast<double>(i), 1.0, 1.0, std::numbers::pi / 2, -1.0});
  }
  for (int i = 1; i <= loops; ++i) {
    made.rods.push_back({i - 1, 0.0, 1.0, 1.0, 0.0, 0.0});
    made.loops.push_back({loops + i, i});
  }
  return made;
}

Mechanism double_pendulum() {
  return {.scene = "study/engines/double_pendulum.json",
          .rods = {{-1, 0.0, 1.0, 1.0, 0.0, 0.0}, {0, 0.0, 1.5, 1.5, 0.0, 2.0}},
          .loops = {},
          .points = 2,
          .four_bar_loops = 0};
}

std::vector<RodState> initial_states(const Mechanism& mechanism) {
  std::vector<double> angles, rates;
  for (const Rod& rod : mechanism.rods) {
    const bool ground = rod.parent < 0;
    const Rod& parent = mechanism.rods[static_cast<std::size_t>(ground ? 0 : rod.parent)];
    angles.push_back(rod.angle - (ground ? 0.0 : parent.angle));
    rates.push_back(rod.rate - (ground ? 0.0 : parent.rate));
  }
  std::vector<RodState> states(mechanism.rods.size());
  states_of_joints(mechanism, angles, rates, states);
  return states;
}

void states_of_joints(const Mechanism& mechanism, const std::vector<double>& angles,
                      const std::vector<double>& rates, std::vector<RodState>& states) {
  std::vector<double> absolute(angles.begin(), angles.end());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Rod& rod = mechanism.rods[i];
    double x = rod.anchor, y = 0.0, vx = 0.0, vy = 0.0, rate = rates[i];
    if (rod.parent >= 0) {
      const auto up = static_cast<std::size_t>(rod.parent);
      const RodState& parent = states[up];
      const double half = mechanism.rods[up].length / 2;
      absolute[i] += absolute[up];
      rate += parent.rate;
      x = parent.x + half * parent.cosine;
      y = parent.y + half * parent.sine;
      vx = parent.vx - half * parent.rate * parent.sine;
      vy = parent.vy + half * parent.rate * parent.cosine;
    }
    const double half = rod.length / 2, c = std::cos(absolute[i]), s = std::sin(absolute[i]);
    states[i] = {x + half * c,         y + half * s,         c,   s,
                 vx - half * rate * s, vy + half * rate * c, rate};
  }
}

}  // namespace engines
