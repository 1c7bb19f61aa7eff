// Sampling of drivers; their share in the derivatives of Phi by time.
#include "drivers.hpp"

#include <algorithm>

namespace mbs::eigen_sparse {

Drivers::Drivers(const Model& model, const Coordinates& coordinates, const std::vector<int>& order)
    : dimension_(model.dimension()),
      velocity_(Vector::Zero(coordinates.extended())),
      acceleration_(Vector::Zero(coordinates.extended())) {
  for (const DrivenPoint& driven : model.driven_points()) {
    for (int axis = 0; axis < dimension_; ++axis) {
      coordinates_.push_back({coordinates.of_point(driven.point, axis), driven.position[axis]});
    }
  }
  if (!model.driven_points().empty()) add_rows(model, coordinates, order);
  std::vector<int> row_of(order.size());
  for (std::size_t row = 0; row < order.size(); ++row) row_of[order[row]] = static_cast<int>(row);
  for (const DrivenValue& driven : model.driven_values()) {
    values_.push_back({row_of[driven.constraint], driven.value});
  }
  for (const DrivenMass& mass : model.driven_mass()) {
    masses_.push_back({coordinates.of_unknown(mass.coordinate),
                       coordinates.of_point(mass.point, mass.axis), mass.value,
                       model.force()[mass.coordinate]});
  }
}

void Drivers::add_rows(const Model& model, const Coordinates& coordinates,
                       const std::vector<int>& order) {
  std::vector<bool> is_driven(model.points().size());
  for (const DrivenPoint& driven : model.driven_points()) is_driven[driven.point] = true;
  const auto dots = model.dot_constraints();
  const auto bilinear = model.bilinear_constraints();
  const auto append = [&](std::size_t row, const auto& constraint, const auto& B) {
    const auto ends = ends_of(constraint);
    if (std::none_of(ends.begin(), ends.end(), [&](int point) { return is_driven[point]; })) return;
    rows_.push_back({static_cast<int>(row), {coordinates, ends}, packed(B, dimension_)});
  };
  constexpr std::array<std::array<double, 3>, 3> kIdentity{
      {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  for (std::size_t row = 0; row < dots.size(); ++row) append(row, dots[order[row]], kIdentity);
  for (std::size_t row = dots.size(); row < dots.size() + bilinear.size(); ++row) {
    const BilinearConstraint& constraint = bilinear[order[row] - dots.size()];
    append(row, constraint, constraint.B);
  }
}

void Drivers::sample(double t, Vector& q, Vector& v, Vector& value, Vector& force) {
  for (const Coordinate& coordinate : coordinates_) {
    const TimeFunction::Sample sample = coordinate.position.at(t);
    q[coordinate.at] = sample.value;
    v[coordinate.at] = velocity_[coordinate.at] = sample.rate;
    acceleration_[coordinate.at] = sample.acceleration;
  }
  for (Value& driven : values_) {
    const TimeFunction::Sample sample = driven.value.at(t);
    value[driven.row] = sample.value;
    driven.rate = sample.rate;
    driven.acceleration = sample.acceleration;
  }
  for (const Mass& mass : masses_) force[mass.at] = mass.force;
  for (const Mass& mass : masses_) force[mass.at] -= mass.value * acceleration_[mass.point];
}

template <int kDimension>
void Drivers::evaluate_rows(const Vector& q) {
  double u[kDimension], w[kDimension], B_w[kDimension], u_B[kDimension];
  for (Row& row : rows_) {
    row.pairs.differences<kDimension>(q.data(), u, w);
    multiply<kDimension>(row.B, w, B_w);
    multiply_transposed<kDimension>(row.B, u, u_B);
    const auto share = [&](const Vector& motion) {
      double u_p[kDimension], w_p[kDimension];
      row.pairs.differences<kDimension>(motion.data(), u_p, w_p);
      return inner<kDimension>(u_p, B_w) + inner<kDimension>(u_B, w_p);  // Eq. (7)
    };
    row.rate = share(velocity_);
    row.acceleration = share(acceleration_);
  }
}

void Drivers::evaluate(const Vector& q) {
  dimension_ == 2 ? evaluate_rows<2>(q) : evaluate_rows<3>(q);
}

void Drivers::add_rates(Vector& result) const {
  for (const Row& row : rows_) result[row.row] += row.rate;
  for (const Value& driven : values_) result[driven.row] -= driven.rate;
}

void Drivers::add_accelerations(Vector& result) const {
  for (const Row& row : rows_) result[row.row] += row.acceleration;
  for (const Value& driven : values_) result[driven.row] -= driven.acceleration;
}

}  // namespace mbs::eigen_sparse
