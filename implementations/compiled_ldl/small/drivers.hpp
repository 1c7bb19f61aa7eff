// Small scenes: what is known as a function of time, sampled once a step.
#pragma once

#include "small/constraints.hpp"

namespace mbs::compiled_ldl {

template <int N, int D>
class SmallDrivers {
 public:
  explicit SmallDrivers(const Model& model) : model_(model) {
    any_ = !model.driven_points().empty() || !model.driven_values().empty();
    for (Prescribed* x : {&velocity_, &acceleration_}) {
      x->points.resize(Difference<N, D>::extent(model), 0.0);
      x->values.resize(model.constraints(), 0.0);
    }
  }

  [[nodiscard]] const Prescribed* velocity() const { return any_ ? &velocity_ : nullptr; }
  [[nodiscard]] const Prescribed* acceleration() const { return any_ ? &acceleration_ : nullptr; }
  [[nodiscard]] bool any() const { return any_; }

  /// Positions of driven points, values of constraints, force −= what driven mass asks for.
  void drive(double t, double* q, double* values, double* force) {
    for (const DrivenPoint& driven : model_.driven_points()) {
      const int row = Difference<N, D>::place(model_, driven.point);
      for (int x = 0; x < D; ++x) {
        const TimeFunction::Sample sample = driven.position[x].at(t);
        q[row + x] = sample.value;
        velocity_.points[row + x] = sample.rate;
        acceleration_.points[row + x] = sample.acceleration;
      }
    }
    for (const DrivenValue& driven : model_.driven_values()) {
      const TimeFunction::Sample sample = driven.value.at(t);
      values[driven.constraint] = sample.value;
      velocity_.values[driven.constraint] = sample.rate;
      acceleration_.values[driven.constraint] = sample.acceleration;
    }
    for (const DrivenMass& mass : model_.driven_mass()) {
      const int row = Difference<N, D>::place(model_, mass.point) + mass.axis;
      force[mass.coordinate] -= mass.value * acceleration_.points[row];
    }
  }
  /// Velocities of driven points, or zero, behind the rows of v.
  void put_velocities(double* v, bool zero) const {
    for (const DrivenPoint& driven : model_.driven_points()) {
      const int row = Difference<N, D>::place(model_, driven.point);
      for (int x = 0; x < D; ++x) v[row + x] = zero ? 0.0 : velocity_.points[row + x];
    }
  }

 private:
  const Model& model_;
  bool any_;
  Prescribed velocity_, acceleration_;
};

}  // namespace mbs::compiled_ldl
