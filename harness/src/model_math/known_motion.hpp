// What a model's drivers prescribe at one instant.
#pragma once

#include <array>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// Motion of the fixed and driven points and the values of the constraints at one time.
class KnownMotion {
 public:
  using Vector = std::array<double, 3>;

  /// `model` must outlive this.
  KnownMotion(const Model& model, double t);

  void set_time(double t);
  [[nodiscard]] double time() const { return time_; }

  /// Of a fixed or driven point, m, m/s and m/s^2; planar: the third component is 0.
  [[nodiscard]] Vector position(int point) const {
    const auto index = static_cast<std::size_t>(point);
    if (!driven_.empty() && driven_[index] >= 0) {
      return positions_[static_cast<std::size_t>(driven_[index])];
    }
    return model_.points()[index].position;
  }
  [[nodiscard]] Vector velocity(int point) const { return of(point, velocities_); }
  [[nodiscard]] Vector acceleration(int point) const { return of(point, accelerations_); }

  /// The value of each constraint, in the order of Phi, with its derivatives.
  [[nodiscard]] const std::vector<TimeFunction::Sample>& values() const;

 private:
  [[nodiscard]] Vector of(int point, const std::vector<Vector>& motion) const;

  const Model& model_;
  double time_ = 0.0;
  std::vector<int> driven_;  // index into driven_points() of a point, -1 without
  std::vector<Vector> positions_, velocities_, accelerations_;  // of the driven points
  mutable std::vector<TimeFunction::Sample> values_;            // empty until somebody asks
};

}  // namespace mbs
