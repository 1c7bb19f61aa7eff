// Lowers the constraints to flat arrays at construction and evaluates them.
#include "constraints.hpp"

#include <algorithm>

namespace mbs::starting_dense {

Constraints::Constraints(const Model& model, const Layout& layout)
    : dimension_(layout.dimension),
      variables_(layout.variables),
      dots_(static_cast<int>(model.dot_constraints().size())),
      phi_(model.constraints()),
      Phi_q_(model.constraints(), layout.moving),
      Phi_q_transposed_(layout.variables, model.constraints()),
      second_derivative_(model.constraints()) {
  for (const DotConstraint& dot : model.dot_constraints()) {
    add_quadratic(layout, {dot.a, dot.b, dot.c, dot.d});
    values_.push_back(dot.value);
  }
  for (const BilinearConstraint& bilinear : model.bilinear_constraints()) {
    add_quadratic(layout, {bilinear.a, bilinear.b, bilinear.c, bilinear.d});
    bilinear_.push_back(bilinear.B);
    values_.push_back(bilinear.value);
  }
  for (const LinearConstraint& linear : model.linear_constraints()) {
    add_linear(linear, static_cast<int>(values_.size()));
    values_.push_back(linear.value);
  }
}

void Constraints::add_quadratic(const Layout& layout, const std::array<int, 4>& points) {
  const int begin = static_cast<int>(blocks_.size());
  // Eq. (7), the Jacobian row: added up where points coincide.
  for (const Share& share : layout.shares(points, layout.moving)) blocks_.push_back(share);
  const auto [a, b, c, d] = points;
  quadratics_.push_back({layout.at[a], layout.at[b], layout.at[c], layout.at[d], begin,
                         static_cast<int>(blocks_.size())});
}

void Constraints::add_linear(const LinearConstraint& constraint, int row) {
  for (const LinearConstraint::Term& term : constraint.terms) {
    Phi_q_(row, term.coordinate) = term.coefficient;
    terms_.push_back(term);
  }
  terms_end_.push_back(static_cast<int>(terms_.size()));
}

void Constraints::evaluate(const Vector& q) {
  for (int row = 0; row < dots_; ++row) evaluate_dot(row, q);
  int row = dots_;
  for (const Matrix3& B : bilinear_) evaluate_bilinear(row++, B, q);
  evaluate_linear(q);
  transpose(Phi_q_, Phi_q_transposed_);
}

void Constraints::evaluate_dot(int row, const Vector& q) {
  const Quadratic& dot = quadratics_[row];
  double sum = 0.0;
  for (int x = 0; x < dimension_; ++x) {  // Eq. (7)
    const double u = q[dot.a + x] - q[dot.b + x];
    const double w = q[dot.c + x] - q[dot.d + x];
    sum += u * w;
    for (int k = dot.blocks_begin; k < dot.blocks_end; ++k) {
      const Share& block = blocks_[k];
      Phi_q_(row, block.at + x) = block.ab * w + block.cd * u;
    }
  }
  phi_[row] = sum - values_[row];
}

void Constraints::evaluate_bilinear(int row, const Matrix3& B, const Vector& q) {
  const Quadratic& bilinear = quadratics_[row];
  const Vector3 u = difference(q, bilinear.a, bilinear.b, dimension_);
  const Vector3 w = difference(q, bilinear.c, bilinear.d, dimension_);
  const Vector3 B_w = product(B, w);
  const Vector3 Bt_u = transposed_product(B, u);
  for (int k = bilinear.blocks_begin; k < bilinear.blocks_end; ++k) {
    const Share& block = blocks_[k];
    for (int x = 0; x < dimension_; ++x) {
      Phi_q_(row, block.at + x) = block.ab * B_w[x] + block.cd * Bt_u[x];
    }
  }
  phi_[row] = dot(u, B_w) - values_[row];  // Eq. (7)
}

void Constraints::evaluate_linear(const Vector& q) {
  int row = static_cast<int>(quadratics_.size());
  int k = 0;
  for (const int end : terms_end_) {  // Eq. (8)
    double sum = -values_[row];
    for (; k < end; ++k) sum += terms_[k].coefficient * q[terms_[k].coordinate];
    phi_[row++] = sum;
  }
}

const Vector& Constraints::second_derivative(const Vector& v, const Drivers& drivers) {
  Vector& result = second_derivative_;
  for (int row = 0; row < dots_; ++row) {  // Eq. (7)
    const Quadratic& dot = quadratics_[row];
    double sum = 0.0;
    for (int x = 0; x < dimension_; ++x) {
      sum += (v[dot.a + x] - v[dot.b + x]) * (v[dot.c + x] - v[dot.d + x]);
    }
    result[row] = 2.0 * sum;
  }
  int row = dots_;
  for (const Matrix3& B : bilinear_) {  // Eq. (7)
    const Quadratic& bilinear = quadratics_[row];
    const Vector3 u = difference(v, bilinear.a, bilinear.b, dimension_);
    const Vector3 w = difference(v, bilinear.c, bilinear.d, dimension_);
    result[row++] = 2.0 * dot(u, product(B, w));
  }
  if (drivers.empty()) return result;
  std::fill(result.begin() + row, result.end(), 0.0);
  drivers.subtract_accelerations(result);
  add_product(Phi_q_, variables_, drivers.acceleration(), result);  // Eqs. (7), (8)
  return result;
}

}  // namespace mbs::starting_dense
