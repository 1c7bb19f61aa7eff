// Judges an engine's states as the harness judges those of an implementation: same metric, same
// bounds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exact/four_bar_exact.hpp"
#include "mechanism.hpp"

namespace engines {

/// Beyond `lost` the motion means nothing, beyond `accurate` a run is degraded: RunBounds and
/// AccurateBounds of harness/src/run/judge.hpp. The gap of a joint, which natural coordinates do
/// not have, is held to the position error's.
struct Bounds {
  double position_error, energy_drift, gap;
};
constexpr Bounds kLost{0.1, 0.1, 0.1};
constexpr Bounds kAccurate{1e-2, 1e-2, 1e-2};

class Judge {
 public:
  explicit Judge(const Mechanism& mechanism);

  /// Judges the states at time t; false if the motion is lost: status() and reason() say how.
  bool judge(double t, const std::vector<RodState>& states);
  /// The same of the points of a scene, of which nothing more is known here.
  bool judge_points(const std::vector<double>& points);

  [[nodiscard]] std::string status() const { return status_; }
  [[nodiscard]] std::string reason() const { return reason_; }
  /// Sets status and reason; returns false.
  bool lose(const std::string& status, const std::string& reason);
  /// "degraded" and why, if a finished run is beyond kAccurate.
  void conclude();

  /// Largest distance of a B_i from its exact place, m; none if the exact motion is not known.
  [[nodiscard]] std::optional<double> position_error() const { return position_error_; }
  /// Largest |E - E_0| over the largest kinetic energy.
  [[nodiscard]] double energy_drift() const { return energy_difference_ / energy_scale_; }
  /// Largest distance of two points that a pin holds together, m.
  [[nodiscard]] double gap() const { return gap_; }

 private:
  void judge_gaps(const std::vector<RodState>& states);
  /// Returns the energy, J; the scale grows with its kinetic part.
  double measure_energy(const std::vector<RodState>& states);
  const Mechanism& mechanism_;
  std::optional<mbs::FourBarExact> exact_;
  std::vector<double> q_;  // of the points B_i
  std::string status_ = "ok", reason_;
  std::optional<double> position_error_;
  double initial_energy_ = 0.0, energy_scale_ = 0.0, energy_difference_ = 0.0, gap_ = 0.0;
};

}  // namespace engines
