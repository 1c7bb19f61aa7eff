// Sampling of the drivers and their terms of Eqs. (6) and (7).
#include "drivers.hpp"

#include <algorithm>

namespace mbs::csc_umfpack {

template <int D>
Drivers<D>::Drivers(const Model& model, const PointLayout& points, const JacobianLayout& layout)
    : gravity_(model.force()) {
  if (model.driven_points().empty() && model.driven_values().empty()) return;
  add_rows(model, points, layout);
  for (const auto& driven : model.driven_points()) {
    points_.push_back({points.offsets[driven.point], driven.position});
  }
  for (Sample* sample : {&now_, &first_, &second_}) {
    sample->points.assign(D * (points_.size() + 1), 0.0);
    sample->values.assign(values_.size() + 1, 0.0);
  }
}

template <int D>
void Drivers<D>::add_rows(const Model& model, const PointLayout& points,
                          const JacobianLayout& layout) {
  std::vector<int> slots(model.points().size(), 0);  // of every point of the Model
  for (int slot = D; const auto& driven : model.driven_points()) {
    slots[driven.point] = slot;
    slot += D;
  }
  for (const auto& mass : model.driven_mass()) {
    masses_.push_back({mass.coordinate, slots[mass.point] + mass.axis, mass.value});
  }
  std::vector<int> rows(layout.order.size());  // rows[row in the Model] = row here
  for (int row = 0; row < layout.rows(); ++row) rows[layout.order[row]] = row;
  std::vector<int> values(rows.size(), 0);
  for (const auto& driven : model.driven_values()) {
    values_.push_back({rows[driven.constraint], driven.value});
    values[driven.constraint] = static_cast<int>(values_.size());
  }
  int k = 0;  // row in the Model
  const auto add = [&](const auto& constraint, const Matrix& B) {
    Row row{.row = rows[k], .B = B, .value = values[k]};
    ++k;
    const int of[] = {constraint.a, constraint.b, constraint.c, constraint.d};
    for (int i = 0; i < 4; ++i) {
      row.points[i] = points.offsets[of[i]];
      row.slots[i] = slots[of[i]];
    }
    if (row.value > 0 || row.slots != std::array<int, 4>{}) rows_.push_back(row);
  };
  constexpr Matrix kIdentity{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  for (const auto& dot : model.dot_constraints()) add(dot, kIdentity);
  for (const auto& bilinear : model.bilinear_constraints()) add(bilinear, bilinear.B);
  for (; k < layout.rows(); ++k) {  // linear ones
    if (values[k] > 0) rows_.push_back({.row = rows[k], .value = values[k]});
  }
}

template <int D>
void Drivers<D>::sample(double t) {
  int slot = D;
  const auto put = [&](std::vector<double> Sample::*list, int at, const TimeFunction& function) {
    const TimeFunction::Sample sample = function.at(t);
    (now_.*list)[at] = sample.value;
    (first_.*list)[at] = sample.rate;
    (second_.*list)[at] = sample.acceleration;
  };
  for (const auto& point : points_) {
    for (int k = 0; k < D; ++k) put(&Sample::points, slot++, point.position[k]);
  }
  for (int at = 1; const auto& value : values_) put(&Sample::values, at++, value.function);
}

template <int D>
void Drivers<D>::move(double* x, double* v) const {
  for (int slot = D; const auto& point : points_) {
    std::copy_n(now_.points.begin() + slot, D, x + point.offset);
    std::copy_n(first_.points.begin() + slot, D, v + point.offset);
    slot += D;
  }
}

template <int D>
void Drivers<D>::set_values(Jacobian<D>& jacobian) const {
  for (int at = 1; const auto& value : values_) jacobian.set_value(value.row, now_.values[at++]);
}

template <int D>
void Drivers<D>::set_force(double* Q) const {
  for (const auto& mass : masses_) Q[mass.coordinate] = gravity_[mass.coordinate];
  for (const auto& mass : masses_) Q[mass.coordinate] -= mass.value * second_.points[mass.slot];
}

template <int D>
double Drivers<D>::term(const Row& row, const double* x, const Sample& derivative) {
  const auto [a, b, c, d] = row.points;
  const auto [p_a, p_b, p_c, p_d] = row.slots;
  const double* p = derivative.points.data();
  return dot(difference<D>(p, p_a, p_b), product(row.B, difference<D>(x, c, d))) +
         dot(difference<D>(x, a, b), product(row.B, difference<D>(p, p_c, p_d))) -
         derivative.values[row.value];
}

template <int D>
void Drivers<D>::add_rates(const double* x, double factor, double* y) const {
  for (const Row& row : rows_) y[row.row] += factor * term(row, x, first_);  // Eq. (7)
}

template <int D>
void Drivers<D>::add_accelerations(const double* x, double factor, double* y) const {
  for (const Row& row : rows_) y[row.row] += factor * term(row, x, second_);  // Eq. (7)
}

template class Drivers<2>;
template class Drivers<3>;

}  // namespace mbs::csc_umfpack
