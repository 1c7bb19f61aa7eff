// T, the right-hand sides and products, along the lists that the set-up has made.
#include "assembly.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::csc_mumps {

bool Assembly::evaluate_tangent() {
  const double* jacobian = jacobian_.data();
  for (std::size_t t = 0; t < target_.size(); ++t) {
    double sum = 0.0;
    for (int k = product_start_[t]; k < product_start_[t + 1]; ++k) {
      sum += jacobian[left_[k]] * jacobian[right_[k]];
    }
    update_[target_[t]] = sum;
  }
  const double factor = quarter_ * penalty_;
  for (std::size_t k = 0; k < tangent_.size(); ++k) {
    tangent_[k] = constant_[k] + factor * update_[k];  // Eq. (5)
  }
  if (!forces_.empty()) forces_.add_to_tangent(tangent_.data());
  double trace = 0.0;  // squares of Phi_q and g are in it, so nothing else is worse
  for (int j = 0; j < variables_; ++j) trace += tangent_[pattern_.start[j]];
  return std::isfinite(trace);
}

void Assembly::newton_right(const double* q_extended, const double* v_extended,
                            const double* acceleration, const double* lambda, double* right) {
  for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] = lambda[i] + penalty_ * phi_[i];
  multiply_mass(acceleration, right);
  if (!forces_.empty()) forces_.evaluate(q_extended, v_extended, right);
  if (!drivers_.empty()) drivers_.add_inertia(right);
  for (int j = 0; j < variables_; ++j) {
    double sum = right[j] - force_[j];
    for (int k = column_start_[j]; k < column_start_[j + 1]; ++k) {
      sum += jacobian_[k] * weights_[row_[k]];
    }
    right[j] = -quarter_ * sum;  // Eq. (3)
  }
}

void Assembly::velocity_right(const double* q_extended, const double* velocity, double* right) {
  multiply_mass(velocity, right);  // Eq. (6)
  if (!forces_.empty()) forces_.multiply(velocity, right);
  if (drivers_.empty()) return;
  std::fill(weights_.begin(), weights_.end(), 0.0);
  drivers_.add_velocity(q_extended, weights_.data());
  subtract_reaction(right);
}

void Assembly::acceleration_right(const double* q_extended, const double* v_extended,
                                  const double* acceleration, double* right) {
  evaluate_weights(v_extended);
  if (!drivers_.empty()) drivers_.add_acceleration(q_extended, weights_.data());
  multiply_mass(acceleration, right);
  if (!forces_.empty()) forces_.multiply(acceleration, right);
  subtract_reaction(right);
}

/// right -= quarter alpha Phi_q' weights.
void Assembly::subtract_reaction(double* right) const {
  const double factor = quarter_ * penalty_;
  for (int j = 0; j < variables_; ++j) {
    double sum = 0.0;
    for (int k = column_start_[j]; k < column_start_[j + 1]; ++k) {
      sum += jacobian_[k] * weights_[row_[k]];
    }
    right[j] -= factor * sum;  // Eq. (6)
  }
}

/// y = M x; each stored entry serves its row and its column.
void Assembly::multiply_mass(const double* x, double* y) const {
  std::fill_n(y, variables_, 0.0);
  for (int j = 0; j < variables_; ++j) {
    const int diagonal = mass_pattern_.start[j];
    double sum = mass_[diagonal] * x[j];
    for (int k = diagonal + 1; k < mass_pattern_.start[j + 1]; ++k) {
      const int i = mass_pattern_.row[k];
      y[i] += mass_[k] * x[j];
      sum += mass_[k] * x[i];
    }
    y[j] += sum;
  }
}

}  // namespace mbs::csc_mumps
