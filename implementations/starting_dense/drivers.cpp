// Samples the functions of time once a step.
#include "drivers.hpp"

namespace mbs::starting_dense {

Drivers::Drivers(const Model& model, const Layout& layout)
    : variables_(layout.variables), acceleration_(layout.moving - layout.variables) {
  for (const DrivenPoint& driven : model.driven_points()) {
    for (int x = 0; x < layout.dimension; ++x) positions_.push_back(&driven.position[x]);
  }
  for (const DrivenValue& driven : model.driven_values()) {
    values_.push_back({driven.constraint, &driven.value, {}});
  }
  for (const mbs::DrivenMass& mass : model.driven_mass()) {
    masses_.push_back({mass.coordinate, layout.at[mass.point] + mass.axis - layout.variables,
                       mass.value, model.force()[mass.coordinate]});
  }
}

void Drivers::sample(double t, Vector& q, Vector& v, Vector& values, Vector& Q) {
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const TimeFunction::Sample sample = positions_[i]->at(t);
    q[variables_ + i] = sample.value;
    v[variables_ + i] = sample.rate;
    acceleration_[i] = sample.acceleration;
  }
  for (Value& value : values_) {
    value.sample = value.function->at(t);
    values[value.constraint] = value.sample.value;
  }
  for (const Mass& mass : masses_) Q[mass.coordinate] = mass.force;
  for (const Mass& mass : masses_) Q[mass.coordinate] -= mass.value * acceleration_[mass.driver];
}

void Drivers::subtract_rates(Vector& result) const {
  for (const Value& value : values_) result[value.constraint] -= value.sample.rate;
}

void Drivers::subtract_accelerations(Vector& result) const {
  for (const Value& value : values_) result[value.constraint] -= value.sample.acceleration;
}

}  // namespace mbs::starting_dense
