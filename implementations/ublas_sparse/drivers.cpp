// Samples the drivers and evaluates Phi_t and its derivative.
#include "drivers.hpp"

#include <algorithm>

namespace mbs::ublas_sparse {

Drivers::Drivers(const Model& model, const Points& points) {
  for (const DrivenPoint& driven : model.driven_points()) {
    points_.push_back({points.first(driven.point), driven.position});
  }
  for (const DrivenValue& driven : model.driven_values()) {
    values_.push_back({driven.constraint, driven.value, {}});
  }
  for (const DrivenMass& mass : model.driven_mass()) {
    masses_.push_back({mass.coordinate, points.first(mass.point) + mass.axis, mass.value});
  }
  if (points_.empty()) return;
  velocity_.assign(points.size(), 0.0);
  acceleration_.assign(points.size(), 0.0);
  add_constraints(model, points);
}

void Drivers::add_constraints(const Model& model, const Points& points) {
  std::vector<char> is_driven(points.size(), 0);
  for (const DrivenCoordinates& driven : points_) is_driven[driven.first] = 1;
  int row = 0;
  const auto add = [&](const auto& constraint, const Matrix3& B) {
    const int a = points.first(constraint.a), b = points.first(constraint.b);
    const int c = points.first(constraint.c), d = points.first(constraint.d);
    if (is_driven[a] || is_driven[b] || is_driven[c] || is_driven[d]) {
      constraints_.push_back({row, a, b, c, d, B});
    }
    ++row;
  };
  const Matrix3 identity{Triple{1, 0, 0}, Triple{0, 1, 0}, Triple{0, 0, 1}};
  for (const DotConstraint& dot : model.dot_constraints()) add(dot, identity);
  for (const BilinearConstraint& bilinear : model.bilinear_constraints()) add(bilinear, bilinear.B);
}

void Drivers::sample(double t, Points& points, Constraints& constraints) {
  for (const DrivenCoordinates& driven : points_) {
    for (int k = 0; k < points.dimension(); ++k) {
      const TimeFunction::Sample sample = driven.position[k].at(t);
      points.drive(driven.first + k, sample.value, sample.rate);
      velocity_[driven.first + k] = sample.rate;
      acceleration_[driven.first + k] = sample.acceleration;
    }
  }
  for (Value& value : values_) {
    value.sample = value.function.at(t);
    constraints.set_value(value.row, value.sample.value);
  }
}

void Drivers::subtract_force(Vector& rhs) const {
  for (const Mass& mass : masses_) rhs(mass.coordinate) += mass.value * acceleration_[mass.driven];
}

void Drivers::add_products(const Points& points, const std::vector<double>& x, Vector& sum) const {
  const double* r = points.position();
  for (const Constraint& constraint : constraints_) {
    const auto& [row, a, b, c, d, B] = constraint;
    const Triple u = points.difference(r, a, b), w = points.difference(r, c, d);
    const Triple x_u = points.difference(x.data(), a, b), x_w = points.difference(x.data(), c, d);
    sum(row) += dot(x_u, times(B, w)) + dot(u, times(B, x_w));
  }
}

void Drivers::add_rate(const Points& points, Vector& rate) const {
  add_products(points, velocity_, rate);                                    // Eq. (7)
  for (const Value& value : values_) rate(value.row) -= value.sample.rate;  // Eqs. (7), (8)
}

void Drivers::add_acceleration_term(const Points& points, Vector& term) const {
  add_products(points, acceleration_, term);                                        // Eq. (7)
  for (const Value& value : values_) term(value.row) -= value.sample.acceleration;  // Eqs. (7), (8)
}

}  // namespace mbs::ublas_sparse
