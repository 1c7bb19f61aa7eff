// Driven points and values: their samples at t', and what they add to Phi_t, its derivative and Q.
#include "drivers.hpp"

namespace mbs::armadillo_dense {

namespace {

constexpr std::array<std::array<double, 3>, 3> kIdentity = {
    {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

}  // namespace

Drivers::Drivers(const Model& model, const Layout& layout) : layout_(layout) {
  if (!model.driven_points().empty()) {
    lower_points(model);
    lower_products(model);
  }
  for (const DrivenValue& driven : model.driven_values()) {
    values_.push_back({.row = driven.constraint, .value = driven.value, .sample = {}});
  }
}

void Drivers::lower_points(const Model& model) {
  rates_ = layout_.zeros();
  accelerations_ = layout_.zeros();
  for (const DrivenPoint& driven : model.driven_points()) {
    points_.push_back({.start = layout_.starts[driven.point], .position = driven.position});
  }
  for (const DrivenMass& mass : model.driven_mass()) {
    masses_.push_back({.coordinate = mass.coordinate,
                       .start = layout_.starts[mass.point] + mass.axis,
                       .value = mass.value,
                       .constant = model.force()[mass.coordinate]});
  }
}

void Drivers::lower_products(const Model& model) {
  std::vector<bool> is_driven(model.points().size(), false);
  for (const DrivenPoint& driven : model.driven_points()) is_driven[driven.point] = true;
  int row = 0;
  const auto lower = [&](const auto& c, const std::array<std::array<double, 3>, 3>& B) {
    if (is_driven[c.a] || is_driven[c.b] || is_driven[c.c] || is_driven[c.d]) {
      products_.push_back({.row = row,
                           .a = layout_.starts[c.a],
                           .b = layout_.starts[c.b],
                           .c = layout_.starts[c.c],
                           .d = layout_.starts[c.d],
                           .B = B});
    }
    ++row;
  };
  for (const DotConstraint& constraint : model.dot_constraints()) lower(constraint, kIdentity);
  for (const BilinearConstraint& constraint : model.bilinear_constraints()) {
    lower(constraint, constraint.B);
  }
}

void Drivers::sample(double t, arma::vec& x, arma::vec& v, arma::vec& values) {
  for (const DrivenPlace& point : points_) {
    for (int k = 0; k < layout_.dimension; ++k) {
      const TimeFunction::Sample sample = point.position[k].at(t);
      x[point.start + k] = sample.value;
      v[point.start + k] = sample.rate;
      rates_[point.start + k] = sample.rate;
      accelerations_[point.start + k] = sample.acceleration;
    }
  }
  for (DrivenRow& driven : values_) {
    driven.sample = driven.value.at(t);
    values[driven.row] = driven.sample.value;
  }
}

void Drivers::load(double h, arma::vec& scaled_Q) const {
  for (const Mass& mass : masses_) scaled_Q[mass.coordinate] = h * mass.constant;
  for (const Mass& mass : masses_) {
    scaled_Q[mass.coordinate] -= h * mass.value * accelerations_[mass.start];
  }
}

void Drivers::add_rates(const arma::vec& x, arma::vec& out) const {
  add_products(x, rates_, out);                                                   // Eq. (7)
  for (const DrivenRow& driven : values_) out[driven.row] -= driven.sample.rate;  // Eqs. (7), (8)
}

void Drivers::add_accelerations(const arma::vec& x, arma::vec& out) const {
  add_products(x, accelerations_, out);  // Eq. (7)
  for (const DrivenRow& driven : values_) {
    out[driven.row] -= driven.sample.acceleration;  // Eqs. (7), (8)
  }
}

void Drivers::add_products(const arma::vec& x, const arma::vec& driven, arma::vec& out) const {
  for (const Product& c : products_) {
    double sum = 0.0;
    for (int i = 0; i < layout_.dimension; ++i) {
      const double u = x[c.a + i] - x[c.b + i];
      const double driven_u = driven[c.a + i] - driven[c.b + i];
      for (int j = 0; j < layout_.dimension; ++j) {
        const double w = x[c.c + j] - x[c.d + j];
        const double driven_w = driven[c.c + j] - driven[c.d + j];
        sum += c.B[i][j] * (driven_u * w + u * driven_w);
      }
    }
    out[c.row] += sum;
  }
}

}  // namespace mbs::armadillo_dense
