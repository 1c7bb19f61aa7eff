// Full dense products, one after another.
#include "assembly.hpp"

#include <span>

namespace mbs::starting_dense {

Assembly::Assembly(const Model& model, const StepSettings& settings)
    : layout_(model),
      factor_(0.25 * settings.step * settings.step * settings.penalty),
      M_(model.variables(), model.variables()),
      Q_(model.force().begin(), model.force().end()),
      constraints_(model, layout_),
      forces_(model, layout_, settings.step),
      drivers_(model, layout_),
      product_(model.variables()),
      rates_(model.constraints()) {
  for (const MassEntry& entry : model.mass()) {
    M_(entry.row, entry.col) = entry.value;
    M_(entry.col, entry.row) = entry.value;
  }
}

void Assembly::residual(const Vector& a, const Vector& multipliers, Vector& right) {
  matmul(M_, a, right);
  matmul(constraints_.Phi_q_transposed(), multipliers, product_);
  for (std::size_t i = 0; i < right.size(); ++i) right[i] += product_[i] - Q_[i];
  forces_.subtract_from(right);
}

void Assembly::tangent(Matrix& result) {
  matmul(constraints_.Phi_q_transposed(), constraints_.Phi_q(), result);
  const double* mass = M_.data();
  double* values = result.data();
  for (std::size_t i = 0; i < result.size(); ++i) values[i] = mass[i] + factor_ * values[i];
  forces_.add_to(result);  // Eq. (5)
}

void Assembly::velocity_right(const Vector& v, Vector& right) {
  matmul(constraints_.Phi_q(), std::span(v).first(layout_.moving), rates_);  // driven points, too
  drivers_.subtract_rates(rates_);
  projection_right(right);
}

void Assembly::acceleration_right(const Vector& v, const Vector& a, Vector& right) {
  rates_ = constraints_.second_derivative(v, drivers_);
  add_product(constraints_.Phi_q(), 0, a, rates_);
  projection_right(right);
}

void Assembly::projection_right(Vector& right) {
  matmul(constraints_.Phi_q_transposed(), rates_, right);
  for (double& entry : right) entry *= -factor_;  // Eq. (6)
}

}  // namespace mbs::starting_dense
