// Points and values that are known functions of time, and what they add to the equations.
#include "drivers.hpp"

namespace mbs::csc_klu {

template <int dim>
Drivers<dim>::Drivers(const DriverPattern<dim>& pattern)
    : pattern_(pattern),
      values_(pattern.values.size(), 0.0),
      rates_(values_),
      accelerations_(values_) {}

template <int dim>
void Drivers<dim>::sample(double t, double* q, double* v, double* a) {
  for (const auto& point : pattern_.points) {
    for (int k = 0; k < dim; ++k) {
      const TimeFunction::Sample sample = (*point.position)[k].at(t);
      q[point.offset + k] = sample.value;
      v[point.offset + k] = sample.rate;
      a[point.offset + k] = sample.acceleration;
    }
  }
  for (std::size_t j = 0; j < values_.size(); ++j) {
    const TimeFunction::Sample sample = pattern_.values[j].value->at(t);
    values_[j] = sample.value;
    rates_[j] = sample.rate;
    accelerations_[j] = sample.acceleration;
  }
}

template <int dim>
void Drivers<dim>::subtract(const std::vector<double>& values, double* z) const {
  for (std::size_t j = 0; j < values.size(); ++j) {
    z[pattern_.values[j].row] -= values[j];  // Eqs. (7), (8)
  }
}

template <int dim>
void Drivers<dim>::subtract_inertia(double factor, const double* a, double* right) const {
  for (const auto& mass : pattern_.masses) {
    right[mass.coordinate] -= factor * mass.value * a[mass.acceleration];
  }
}

template class Drivers<2>;
template class Drivers<3>;

}  // namespace mbs::csc_klu
