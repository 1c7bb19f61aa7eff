// Driven points and values: their samples at t', and their share of Q.
#include "drivers.hpp"

namespace mbs::armadillo_dense {

Drivers::Drivers(const Model& model, const Layout& layout) : dimension_(layout.dimension) {
  for (const DrivenPoint& driven : model.driven_points()) {
    points_.push_back({.start = layout.starts[driven.point], .position = driven.position});
  }
  for (const DrivenMass& mass : model.driven_mass()) {
    masses_.push_back({.coordinate = mass.coordinate,
                       .start = layout.starts[mass.point] + mass.axis,
                       .value = mass.value,
                       .constant = model.force()[mass.coordinate]});
  }
  for (const DrivenValue& driven : model.driven_values()) {
    values_.push_back({.row = driven.constraint, .value = driven.value, .sample = {}});
  }
}

void Drivers::sample(double t, arma::vec& x, arma::vec& v, arma::vec& a, arma::vec& values) {
  for (const DrivenPlace& point : points_) {
    for (int k = 0; k < dimension_; ++k) {
      const TimeFunction::Sample sample = point.position[k].at(t);
      x[point.start + k] = sample.value;
      v[point.start + k] = sample.rate;
      a[point.start + k] = sample.acceleration;
    }
  }
  for (DrivenRow& driven : values_) {
    driven.sample = driven.value.at(t);
    values[driven.row] = driven.sample.value;
  }
}

void Drivers::load(double h, const arma::vec& a, arma::vec& scaled_Q) const {
  for (const Mass& mass : masses_) scaled_Q[mass.coordinate] = h * mass.constant;
  for (const Mass& mass : masses_) scaled_Q[mass.coordinate] -= h * mass.value * a[mass.start];
}

void Drivers::subtract_rates(arma::vec& out) const {
  for (const DrivenRow& driven : values_) out[driven.row] -= driven.sample.rate;
}

void Drivers::subtract_accelerations(arma::vec& out) const {
  for (const DrivenRow& driven : values_) out[driven.row] -= driven.sample.acceleration;
}

}  // namespace mbs::armadillo_dense
