// Small scenes: what is known as a function of time, sampled once a step.
#pragma once

#include "small/constraints.hpp"

namespace mbs::compiled_ldl {

/// Point 3 is driven, and so is the length of a rod, constraint 0. In the plane with N = 6, kSize =
/// 8, q has the point in places 14 and 15; rates_ = {ṡ, 0, …}.
template <int N, int D>
class SmallDrivers {
 public:
  explicit SmallDrivers(const Model& model) : model_(model) {
    any_ = !model.driven_points().empty() || !model.driven_values().empty();
    rates_.resize(model.constraints(), 0.0);
    accelerations_.resize(model.constraints(), 0.0);
  }

  [[nodiscard]] bool any() const { return any_; }
  /// ṡ and s̈ by the constraint's number; nullptr without drivers.
  [[nodiscard]] const double* rates() const { return any_ ? rates_.data() : nullptr; }
  [[nodiscard]] const double* accelerations() const {
    return any_ ? accelerations_.data() : nullptr;
  }

  /// What driven points have behind the rows of q, v and a, values of constraints, force −= what
  /// driven mass asks for.
  void drive(double t, double* q, double* v, double* a, double* values, double* force) {
    for (const DrivenPoint& driven : model_.driven_points()) {
      const int row = Difference<N, D>::place(model_, driven.point);
      for (int x = 0; x < D; ++x) {
        const TimeFunction::Sample sample = driven.position[x].at(t);
        q[row + x] = sample.value;
        v[row + x] = sample.rate;
        a[row + x] = sample.acceleration;
      }
    }
    for (const DrivenValue& driven : model_.driven_values()) {
      const TimeFunction::Sample sample = driven.value.at(t);
      values[driven.constraint] = sample.value;
      rates_[driven.constraint] = sample.rate;
      accelerations_[driven.constraint] = sample.acceleration;
    }
    for (const DrivenMass& mass : model_.driven_mass()) {
      const int row = Difference<N, D>::place(model_, mass.point) + mass.axis;
      force[mass.coordinate] -= mass.value * a[row];
    }
  }

 private:
  const Model& model_;
  bool any_;
  Array<double> rates_, accelerations_;
};

}  // namespace mbs::compiled_ldl
