// Driven points, values and masses at the end of a step.
#include "drivers.hpp"

namespace mbs::csc_umfpack {

template <int D>
Drivers<D>::Drivers(const Model& model, const PointLayout& points, const JacobianLayout& layout)
    : gravity_(model.force()) {
  for (const auto& driven : model.driven_points()) {
    points_.push_back({points.offsets[driven.point], driven.position});
  }
  for (const auto& mass : model.driven_mass()) {
    masses_.push_back({mass.coordinate, points.offsets[mass.point] + mass.axis, mass.value});
  }
  std::vector<int> rows(layout.order.size());  // rows[row in the Model] = row here
  for (int row = 0; row < layout.rows(); ++row) rows[layout.order[row]] = row;
  for (const auto& driven : model.driven_values()) {
    values_.push_back({rows[driven.constraint], driven.value, {}});
  }
}

template <int D>
void Drivers<D>::move(double t, double* x, double* v, double* a) const {
  for (const auto& point : points_) {
    for (int k = 0; k < D; ++k) {
      const TimeFunction::Sample sample = point.position[k].at(t);
      x[point.offset + k] = sample.value;
      v[point.offset + k] = sample.rate;
      a[point.offset + k] = sample.acceleration;
    }
  }
}

template <int D>
void Drivers<D>::set_values(double t, Jacobian<D>& jacobian) {
  for (auto& value : values_) {
    value.sample = value.function.at(t);
    jacobian.set_value(value.row, value.sample.value);
  }
}

template <int D>
void Drivers<D>::set_force(const double* a, double* Q) const {
  for (const auto& mass : masses_) Q[mass.coordinate] = gravity_[mass.coordinate];
  for (const auto& mass : masses_) Q[mass.coordinate] -= mass.value * a[mass.driven];
}

template <int D>
void Drivers<D>::subtract_rates(double* y) const {
  for (const auto& value : values_) y[value.row] -= value.sample.rate;
}

template <int D>
void Drivers<D>::subtract_second_rates(double* y) const {
  for (const auto& value : values_) y[value.row] -= value.sample.acceleration;
}

template class Drivers<2>;
template class Drivers<3>;

}  // namespace mbs::csc_umfpack
