// Full dense products, one after another.
#include "assembly.hpp"

namespace mbs::starting_dense {

Assembly::Assembly(const Model& model, const StepSettings& settings)
    : layout_(model),
      factor_(0.25 * settings.step * settings.step * settings.penalty),
      M_(model.variables(), model.variables()),
      Q_(model.force().begin(), model.force().end()),
      constraints_(model, layout_),
      forces_(model, layout_, settings.step),
      drivers_(model, layout_),
      product_(model.variables()) {
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
  multiply(v, right);
  if (driven()) subtract_transposed(constraints_.time_derivative(drivers_), right);  // Eq. (6)
}

void Assembly::acceleration_right(const Vector& a, const Vector& v, Vector& right) {
  multiply(a, right);
  subtract_transposed(constraints_.second_derivative(v, drivers_), right);  // Eq. (6)
}

void Assembly::multiply(const Vector& x, Vector& right) {
  matmul(M_, x, right);
  forces_.add_product(x, right);
}

void Assembly::subtract_transposed(const Vector& y, Vector& right) {
  matmul(constraints_.Phi_q_transposed(), y, product_);
  for (std::size_t i = 0; i < right.size(); ++i) right[i] -= factor_ * product_[i];
}

}  // namespace mbs::starting_dense
