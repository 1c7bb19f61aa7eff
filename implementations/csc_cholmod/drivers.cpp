// Samples go to where constants and targets stand.
#include "drivers.hpp"

namespace mbs::csc_cholmod {

Drivers::Drivers(const Model& model, const StepSettings& settings, const Coordinates& coordinates,
                 const LoweredConstraints& lowered, const std::vector<double>& force)
    : coordinates_(coordinates),
      half_(settings.step / 2.0),
      quarter_(half_ * half_),
      points_(model.driven_points()) {
  for (const DrivenValue& v : model.driven_values()) {
    targets_.push_back({lowered.row(v.constraint), &v.value});
  }
  for (const DrivenMass& m : model.driven_mass()) {
    const int place = coordinates.number()[m.coordinate];
    mass_.push_back({place, coordinates.place(m.point, m.axis), m.value, force[place]});
  }
}

void Drivers::drive(double t, double* q, double* u, double* s, double* target, double* force) {
  for (const DrivenPoint& p : points_) {
    for (int axis = 0; axis < coordinates_.dimension(); ++axis) {
      const TimeFunction::Sample sample = p.position[axis].at(t);
      const int place = coordinates_.place(p.point, axis);
      q[place] = sample.value;
      u[place] = half_ * sample.rate;
      s[place] = quarter_ * sample.acceleration;
    }
  }
  for (DrivenTarget& d : targets_) {
    const TimeFunction::Sample sample = d.function->at(t);
    target[d.row] = sample.value;
    d.rate = half_ * sample.rate;
    d.acceleration = quarter_ * sample.acceleration;
  }
  for (const Mass& m : mass_) force[m.place] = m.force;
  for (const Mass& m : mass_) force[m.place] -= m.value * s[m.source];
}

}  // namespace mbs::csc_cholmod
