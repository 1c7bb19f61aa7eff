// The N-four-bar mechanism with what may change violently: masses, contacts, multipliers.
#pragma once

#include <vector>

#include "csc_klu/storage.hpp"

namespace mbs::stale_pivots {

using namespace csc_klu;  // whose storage and solvers are measured

inline constexpr int kLoops = 40;
inline constexpr int kConstraints = 2 * kLoops + 1;

/// The mechanism of paper/README.md at one instant: kLoops + 1 rods stand on the ground.
struct Instant {
  double angle = 0.0;  ///< of all rods from the upward vertical, rad
  double penalty = 0.0;
  std::vector<double> rod_mass =
      std::vector<double>(kLoops + 1, 1.0);  ///< kg, those from the ground
  double coupler_mass = 1.0;                 ///< kg
  /// Of a contact at the moving end of each rod: a compressed horizontal spring, N/m.
  std::vector<double> contact = std::vector<double>(kLoops + 1, 0.0);
  std::vector<double> lambda = {};  ///< none: without Eq. (16); else one a constraint, N/m
};

/// A matrix on its pattern.
struct Matrix {
  Pattern pattern;
  std::vector<int> order;  ///< of elimination
  std::vector<double> values;
};

/// T of Eq. (5).
[[nodiscard]] Matrix tangent_matrix(const Instant& instant);

/// Scales of the multipliers as a simulation that starts there has them.
[[nodiscard]] std::vector<double> scales_at(const Instant& instant);
/// The matrix of Eq. (12) with these scales of the multipliers.
[[nodiscard]] Matrix saddle_matrix(const Instant& instant, const std::vector<double>& scales);

}  // namespace mbs::stale_pivots
