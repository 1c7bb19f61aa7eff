// What a model prescribes as a function of time: driven points, driven values, driven mass.
#include "drivers.hpp"

namespace mbs::eigen_dense {

template <typename Scalar>
Drivers<Scalar>::Drivers(const Model& model, const Layout& layout)
    : dimension_(layout.dimension()) {
  for (const DrivenValue& driven : model.driven_values()) {
    values_.push_back({driven.constraint, driven.value, {}});
  }
  if (model.driven_points().empty()) return;
  velocity_ = acceleration_ = q_ = Vector::Zero(layout.extended_size());
  for (const DrivenPoint& driven : model.driven_points()) {
    points_.push_back({layout.start(driven.point), driven.position});
  }
  for (const DrivenMass& mass : model.driven_mass()) {
    mass_.push_back({mass.coordinate, layout.start(mass.point) + mass.axis, Scalar(mass.value)});
  }
  lower_constraints(model, layout);
}

template <typename Scalar>
void Drivers<Scalar>::lower_constraints(const Model& model, const Layout& layout) {
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
  std::vector<bool> is_driven(model.points().size());
  for (const DrivenPoint& driven : model.driven_points()) is_driven[driven.point] = true;
  Index row = 0;
  const auto lower = [&](const auto& constraint, const Matrix3& B) {
    const auto& [a, b, c, d] = constraint;
    if (is_driven[a] || is_driven[b] || is_driven[c] || is_driven[d]) {
      quadratics_.push_back(
          {layout.start(a), layout.start(b), layout.start(c), layout.start(d), B, row});
    }
    ++row;
  };
  for (const DotConstraint& dot : model.dot_constraints()) {
    lower(std::array{dot.a, dot.b, dot.c, dot.d}, Matrix3::Identity());
  }
  for (const BilinearConstraint& bilinear : model.bilinear_constraints()) {
    Matrix3 B;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) B(i, j) = Scalar(bilinear.B[i][j]);
    }
    lower(std::array{bilinear.a, bilinear.b, bilinear.c, bilinear.d}, B);
  }
}

template <typename Scalar>
void Drivers<Scalar>::drive(double t, Vector& q, Vector& v) {
  for (const MovedPoint& point : points_) {
    for (int axis = 0; axis < dimension_; ++axis) {
      const TimeFunction::Sample now = point.position[axis].at(t);
      const Index i = point.start + axis;
      q[i] = Scalar(now.value);
      v[i] = velocity_[i] = Scalar(now.rate);
      acceleration_[i] = Scalar(now.acceleration);
    }
  }
  for (Value& value : values_) value.now = value.function.at(t);
}

template <typename Scalar>
void Drivers<Scalar>::evaluate(const Vector& q, Vector& Phi) {
  if (!points_.empty()) q_ = q;
  for (const Value& value : values_) Phi[value.row] -= Scalar(value.now.value);
}

template <typename Scalar>
void Drivers<Scalar>::add_force(Scalar factor, Vector& rhs) const {
  for (const Mass& mass : mass_) {
    rhs[mass.coordinate] -= factor * mass.value * acceleration_[mass.source];
  }
}

template <typename Scalar>
template <int dimension>
void Drivers<Scalar>::add_products(const Scalar* rates, Scalar* term) const {
  const Scalar* const q = q_.data();
  for (const Quadratic& constraint : quadratics_) {
    const auto [a, b, c, d, full_B, row] = constraint;
    const Eigen::Matrix<Scalar, dimension, dimension> B =
        full_B.template topLeftCorner<dimension, dimension>();
    term[row] += difference<dimension>(rates, a, b).dot(B * difference<dimension>(q, c, d)) +
                 difference<dimension>(q, a, b).dot(B * difference<dimension>(rates, c, d));
  }
}

template <typename Scalar>
void Drivers<Scalar>::add_products(const Vector& rates, Vector& term) const {
  dimension_ == 2 ? add_products<2>(rates.data(), term.data())
                  : add_products<3>(rates.data(), term.data());
}

template <typename Scalar>
void Drivers<Scalar>::add_velocity_term(Vector& term) const {
  add_products(velocity_, term);                                                 // Eq. (7)
  for (const Value& value : values_) term[value.row] -= Scalar(value.now.rate);  // Eqs. (7), (8)
}

template <typename Scalar>
void Drivers<Scalar>::add_acceleration_term(Vector& term) const {
  add_products(acceleration_, term);  // Eq. (7)
  for (const Value& value : values_)
    term[value.row] -= Scalar(value.now.acceleration);  // Eqs. (7), (8)
}

template class Drivers<double>;
template class Drivers<float>;

}  // namespace mbs::eigen_dense
