// How far the forces and accelerations that a scene asks for are from those of its motion.
#pragma once

#include <string>
#include <vector>

#include "run/output_values.hpp"

namespace mbs {

/// Positions and velocities determine accelerations and multipliers, consistent_state(). Those of a
/// step are others, while the motion is right: the trapezoidal forms have forces of first order;
/// accelerations that are not projected swing from step to step; a penalty factor multiplies
/// rounding.
///
///   ForceErrors errors(scene);
///   if (errors.is_needed()) errors.compare(t, state);  // at some instants
///   std::string what = errors.beyond();
class ForceErrors {
 public:
  /// `scene` must outlive this.
  explicit ForceErrors(const Scene& scene);

  /// Whether the scene's outputs have accelerations or constraint forces.
  [[nodiscard]] bool is_needed() const { return !asked_.empty(); }
  void compare(double t, const State& state);

  /// Whether an output is further off than AccurateBounds::force of its largest value so far, or of
  /// a thousandth of what it would be with the scene's largest acceleration and force.
  [[nodiscard]] bool is_beyond() const { return !beyond().empty(); }
  /// Says which is most, and by how much; empty if none is.
  [[nodiscard]] std::string beyond() const;

 private:
  struct Asked {
    const std::string* name;
    std::size_t column, columns;
    double off = 0.0, largest = 0.0;  // N, N m, m/s^2 ...
  };
  /// All outputs.
  [[nodiscard]] std::vector<double> values(double t, const State& state);
  [[nodiscard]] State largest(double t, const State& right) const;

  const Scene& scene_;
  OutputValues outputs_;
  std::vector<Asked> asked_;
};

}  // namespace mbs
