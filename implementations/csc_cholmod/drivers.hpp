// Known functions of time: driven points and values, and what driven mass adds to Q.
#pragma once

#include <span>
#include <vector>

#include "coordinates.hpp"
#include "lowering.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::csc_cholmod {

/// The value s of a row of Phi.
struct DrivenTarget {
  int row = 0;
  const TimeFunction* function = nullptr;
  double rate = 0.0;          ///< (dt/2) s'
  double acceleration = 0.0;  ///< (dt^2/4) s''
};

/// Samples of one instant, scaled as velocities and accelerations are everywhere here. A model
/// without drivers has an empty one.
class Drivers {
 public:
  /// `model` and `coordinates` must outlive this. `force`: (dt^2/4) times the constant part of Q.
  Drivers(const Model& model, const StepSettings& settings, const Coordinates& coordinates,
          const LoweredConstraints& lowered, const std::vector<double>& force);

  [[nodiscard]] bool empty() const { return points_.empty() && targets_.empty(); }
  /// Samples at time t: positions, velocities and accelerations of points into q, u and s (all
  /// places), values into target (rows), and what driven mass gives into force (n).
  void drive(double t, double* q, double* u, double* s, double* target, double* force);

  [[nodiscard]] std::span<const DrivenTarget> targets() const { return targets_; }

 private:
  struct Mass {
    int place = 0;
    int source = 0;  ///< the place of the point's coordinate
    double value = 0.0;
    double force = 0.0;  ///< the constant part
  };

  const Coordinates& coordinates_;
  double half_;     ///< dt/2, s
  double quarter_;  ///< dt^2/4, s^2
  std::span<const DrivenPoint> points_;
  std::vector<DrivenTarget> targets_;
  std::vector<Mass> mass_;
};

}  // namespace mbs::csc_cholmod
