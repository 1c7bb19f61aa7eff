// What single steps leave, point by point, and how far that carries each point over a run.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "run/scene_distance.hpp"
#include "run/step_again.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// Adds up errors of single steps along the way of each point; across it the constraints take them
/// away if they leave one freedom. A point is off by the sum of its lags and by the way that a
/// wrong speed goes:
///
///   lag  = sum of |off . v|/|v|, or of |off| where freedoms pass energy on to each other   m
///          (a lag is a time: it grows with the largest |v| so far)
///   way of shifts = t sqrt(mean of |off/dt|^2), there    m
///   gain of v^2/2 by the lesser of now . v and later . v, if their signs agree, m^2/s^2
///   way  = sum of dt gain/|v|, at most dt |v|            m
///
/// Rounding and passes leave something else in each step, so that m samples of N steps, with mean x
/// and root mean square r, gain N max(0, |x| - 2 r/sqrt(m)) + r sqrt(N): their mean, as far as that
/// is no chance, and a random walk. Dampers take gains away as they take energy.
///
///   LocalErrors errors(scene, judged_length(scene.model), watch.passes_on());
///   errors.add(off, v, 1.25e-3, 64);         // 64 steps like this one
///   errors.add_speed(again.error(before, after), v, 1.25e-3, 512, 0.0);
///   double share = errors.worst().share;
class LocalErrors {
 public:
  /// `scene` must outlive this; unit vectors count as `length` (m) long. `passes_on`: of each
  /// coordinate, as ClosedParts; nothing is added if it is empty.
  LocalErrors(const Scene& scene, double length, const std::vector<bool>& passes_on);

  /// `steps` steps of `step` (s) that each left the positions `off` (n, m) at the velocity `v` (n,
  /// m/s). Returns the speed of the fastest point, m/s. A rule that leaves `off` in a step also
  /// shifts the speed by off/step. With one freedom the shift comes back with the motion, or energy
  /// shows it. Freedoms that pass energy on to each other keep some of it, about its root mean
  /// square.
  double add(std::span<const double> off, std::span<const double> v, double step, long steps);
  /// `steps` steps of `step` (s) that each left the velocity too high by `error` while dampers took
  /// `braked` (1/s) of the kinetic energy.
  void add_speed(const SpeedError& error, std::span<const double> v, double step, long steps,
                 double braked);

  /// Lag + way + way of shifts so far of the point for which it is the most of its length.
  struct Worst {
    double sum = 0.0;    ///< m
    double share = 0.0;  ///< of lengths_of_points(), or of that of a ShortLink
    std::string point = "";
  };
  [[nodiscard]] Worst worst() const;

 private:
  struct Sums {
    const std::string* name;
    double length;  // m
    bool passes_on = false;
    double lag = 0.0, way = 0.0;
    double fastest = 0.0;                   // |v|^2, m^2/s^2
    double gain = 0.0, gain_squared = 0.0;  // of samples
    double shift = 0.0;                     // sum of dt |off/dt|^2, m^2/s
  };

  const Scene& scene_;
  double length_;
  std::vector<ShortLink> links_;
  std::vector<Sums> points_;            // in the order of for_each_point(), then the links
  double samples_ = 0.0, steps_ = 0.0;  // m, N, without what dampers took away
  double time_ = 0.0;                   // t of shifts, s
};

}  // namespace mbs
