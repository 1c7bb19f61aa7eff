// Set-up, sampling and use of the drivers; lists of driven things only, none of them long.
#include "drivers.hpp"

#include <algorithm>

namespace mbs::csc_mumps {

Drivers::Drivers(const Model& model, const ExtendedPoints& points, std::span<double* const> values)
    : dimension_(model.dimension()) {
  if (model.driven_points().empty() && model.driven_values().empty()) return;
  std::vector<int> slot(model.points().size(), 0);
  int slots = dimension_;
  for (const DrivenPoint& driven : model.driven_points()) {
    points_.push_back({points.offset[driven.point], driven.position});
    slot[driven.point] = slots;
    slots += dimension_;
  }
  for (const DrivenValue& driven : model.driven_values()) {
    values_.push_back({driven.constraint, values[driven.constraint], driven.value});
    ++slots;
  }
  rates_.velocity.assign(slots, 0.0);
  rates_.acceleration.assign(slots, 0.0);

  int row = 0;
  for (const DotConstraint& dot : model.dot_constraints()) {
    add_product(dot, {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}}, row++, points, slot);
  }
  for (const BilinearConstraint& bilinear : model.bilinear_constraints()) {
    add_product(bilinear, bilinear.B, row++, points, slot);
  }
  for (const DrivenMass& mass : model.driven_mass()) {
    mass_.push_back({mass.coordinate, slot[mass.point] + mass.axis, mass.value});
  }
}

/// Keeps a constraint if it has a driven point.
template <class Constraint>
void Drivers::add_product(const Constraint& constraint,
                          const std::array<std::array<double, 3>, 3>& B, int row,
                          const ExtendedPoints& points, const std::vector<int>& slot) {
  Product product{{}, {}, B, row};
  const std::array<int, 4> point = {constraint.a, constraint.b, constraint.c, constraint.d};
  for (int i = 0; i < 4; ++i) {
    product.at[i] = points.offset[point[i]];
    product.slot[i] = slot[point[i]];
  }
  if (product.slot != std::array<int, 4>{}) products_.push_back(product);
}

void Drivers::sample(double t, double* q, double* v) {
  int slot = dimension_;
  const auto keep = [&](const TimeFunction::Sample& sample) {
    rates_.velocity[slot] = sample.rate;
    rates_.acceleration[slot] = sample.acceleration;
    ++slot;
  };
  for (const DrivenPlace& point : points_) {
    for (int axis = 0; axis < dimension_; ++axis) {
      const TimeFunction::Sample sample = point.position[axis].at(t);
      q[point.offset + axis] = sample.value;
      v[point.offset + axis] = sample.rate;
      keep(sample);
    }
  }
  for (const Value& value : values_) {
    const TimeFunction::Sample sample = value.function.at(t);
    *value.kept = sample.value;
    keep(sample);
  }
}

void Drivers::add(std::vector<double> Rates::*derivative, const double* q, double* result) const {
  const double* p = (rates_.*derivative).data();
  for (const auto& [at, slot, B, row] : products_) {
    double sum = 0.0;
    for (int i = 0; i < dimension_; ++i) {
      for (int j = 0; j < dimension_; ++j) {
        const double u = q[at[0] + i] - q[at[1] + i];
        const double w = q[at[2] + j] - q[at[3] + j];
        const double u_p = p[slot[0] + i] - p[slot[1] + i];
        const double w_p = p[slot[2] + j] - p[slot[3] + j];
        sum += B[i][j] * (u_p * w + u * w_p);  // Eq. (7)
      }
    }
    result[row] += sum;
  }
  p += dimension_ * (1 + points_.size());
  for (const Value& value : values_) result[value.row] -= *p++;  // Eqs. (7), (8)
}

void Drivers::add_inertia(double* right) const {
  for (const Mass& mass : mass_) {
    right[mass.coordinate] += mass.value * rates_.acceleration[mass.slot];
  }
}

}  // namespace mbs::csc_mumps
