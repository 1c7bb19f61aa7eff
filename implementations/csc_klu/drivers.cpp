// Points and values that are known functions of time, and what they add to the equations.
#include "drivers.hpp"

namespace mbs::csc_klu {

template <int dim>
Drivers<dim>::Drivers(const DriverPattern<dim>& pattern,
                      const JacobianPattern<dim>& jacobian_pattern)
    : pattern_(pattern),
      jacobian_pattern_(jacobian_pattern),
      values_(pattern.values.size(), 0.0),
      z_(pattern.rows.size(), 0.0) {
  if (!any()) return;
  for (Derivatives* derivatives : {&rates_, &accelerations_}) {
    derivatives->points.assign(dim * (pattern.points.size() + 1), 0.0);
    derivatives->values.assign(pattern.values.size() + 1, 0.0);
  }
}

template <int dim>
void Drivers<dim>::sample(double t, double* q, double* v) {
  double* rate = rates_.points.data() + dim;
  double* acceleration = accelerations_.points.data() + dim;
  for (const auto& point : pattern_.points) {
    for (int k = 0; k < dim; ++k) {
      const TimeFunction::Sample sample = (*point.position)[k].at(t);
      q[point.offset + k] = sample.value;
      v[point.offset + k] = *rate++ = sample.rate;
      *acceleration++ = sample.acceleration;
    }
  }
  for (std::size_t j = 0; j < values_.size(); ++j) {
    const TimeFunction::Sample sample = pattern_.values[j].value->at(t);
    values_[j] = sample.value;
    rates_.values[j + 1] = sample.rate;
    accelerations_.values[j + 1] = sample.acceleration;
  }
}

template <int dim>
void Drivers<dim>::subtract_values(double* phi) const {
  for (std::size_t j = 0; j < values_.size(); ++j) {
    phi[pattern_.values[j].row] -= values_[j];  // Eqs. (7), (8)
  }
}

template <int dim>
void Drivers<dim>::place(const Derivatives& derivatives, double* x) const {
  const double* moved = derivatives.points.data() + dim;
  for (const auto& point : pattern_.points) {
    for (int k = 0; k < dim; ++k) x[point.offset + k] = *moved++;
  }
}

template <int dim>
void Drivers<dim>::subtract_values(const Derivatives& derivatives, double* z) const {
  for (std::size_t j = 0; j < values_.size(); ++j) {
    z[pattern_.values[j].row] -= derivatives.values[j + 1];  // Eqs. (7), (8)
  }
}

template <int dim>
void Drivers<dim>::subtract_inertia(double factor, double* right) const {
  for (const auto& mass : pattern_.masses) {
    right[mass.coordinate] -= factor * mass.value * accelerations_.points[mass.acceleration];
  }
}

template <int dim>
void Drivers<dim>::subtract(const Jacobian<dim>& jacobian, const double* q,
                            const Derivatives& derivatives, double factor, double* y) {
  const double* const moved = derivatives.points.data();
  double* z = z_.data();
  for (const auto& row : pattern_.rows) {
    const Vector<dim> u = difference<dim>(q, row.at[0], row.at[1]);
    const Vector<dim> w = difference<dim>(q, row.at[2], row.at[3]);
    const Vector<dim> u_p = difference<dim>(moved, row.moved[0], row.moved[1]);
    const Vector<dim> w_p = difference<dim>(moved, row.moved[2], row.moved[3]);
    *z++ = factor * (dot(u_p, product(row.B, w)) + dot(u, product(row.B, w_p)) -
                     derivatives.values[row.value]);  // Eq. (7)
  }
  for (const auto& term : pattern_.terms) {
    const double* const block = jacobian.block(term.block);
    double* const at = y + term.coordinate;
    for (int k = 0; k < dim; ++k) at[k] -= z_[term.row] * block[k];  // Eq. (6)
  }
  for (const auto& linear : pattern_.linears) {
    const double rate = -factor * derivatives.values[linear.value];  // Eq. (8)
    for (int k = linear.begin; k < linear.end; ++k) {
      const auto& [coordinate, coefficient] = jacobian_pattern_.linear_terms[k];
      y[coordinate] -= coefficient * rate;  // Eq. (6)
    }
  }
}

template class Drivers<2>;
template class Drivers<3>;

}  // namespace mbs::csc_klu
