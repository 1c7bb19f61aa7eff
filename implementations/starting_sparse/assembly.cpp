// Constraints, residual, tangent and right-hand sides, along the lists made at set-up.
#include "assembly.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::starting_sparse {

void Assembly::evaluate(const double* q) {
  if (is_driven()) evaluated_.assign(q, q + evaluated_.size());
  dimension_ == 2 ? evaluate_dots<2>(q) : evaluate_dots<3>(q);
  for (int row = quadratic_count_; row < constraints_; ++row) {
    double sum = -value_[row];
    for (int k = row_start_[row]; k < row_start_[row + 1]; ++k) {
      sum += jacobian_[nonzero_place_[k]] * q[nonzero_column_[k]];
    }
    phi_[row] = sum;  // Eq. (8)
  }
}

template <int kDimension>
void Assembly::evaluate_dots(const double* q) {
  double* jacobian = jacobian_.data();
  for (const Distance& distance : distances_) {
    double square = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      const double difference = q[distance.a + axis] - q[distance.b + axis];
      square += difference * difference;
      jacobian[distance.to_a + axis] = 2.0 * difference;
      jacobian[distance.to_b + axis] = -2.0 * difference;
    }
    phi_[distance.row] = square - value_[distance.row];  // Eq. (7)
  }
  for (const Dot& dot : dots_) {
    double product = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      const double first = q[dot.a + axis] - q[dot.b + axis];
      const double second = q[dot.c + axis] - q[dot.d + axis];
      product += first * second;
      for (int place : {dot.to_a, dot.to_b, dot.to_c, dot.to_d}) jacobian[place + axis] = 0.0;
      jacobian[dot.to_a + axis] += second;
      jacobian[dot.to_b + axis] -= second;
      jacobian[dot.to_c + axis] += first;
      jacobian[dot.to_d + axis] -= first;
    }
    phi_[dot.row] = product - value_[dot.row];  // Eq. (7)
  }
  evaluate_bilinears<kDimension>(q);
}

bool Assembly::is_finite() const {
  double sum = 0.0;  // what makes Phi_q infinite or undefined does so with Phi
  for (double value : phi_) sum += std::abs(value);
  return std::isfinite(sum) && forces_.is_finite();
}

void Assembly::residual(const double* q, const double* v, const double* a, const double* lambda,
                        double* right) {
  for (int i = 0; i < constraints_; ++i) multiplier_[i] = lambda[i] + penalty_ * phi_[i];
  multiply_mass(a, right);
  for (int i = 0; i < constraints_; ++i) add_gradient(i, multiplier_[i], right);
  for (int i = 0; i < variables_; ++i) right[i] = weight_ * (force_[i] - right[i]);  // Eq. (3)
  forces_.add_forces(q, v, right);
}

void Assembly::assemble() {
  const double factor = weight_ * penalty_;
  double* products = values_.data() + mass_count_;
  for (std::size_t k = 0; k < left_.size(); ++k) {
    products[k] = factor * jacobian_[left_[k]] * jacobian_[right_[k]];  // Eq. (5)
  }
  forces_.assemble(values_.data() + forces_first_);
}

void Assembly::project_velocity(const double* v, double* right) {
  std::fill(multiplier_.begin(), multiplier_.end(), 0.0);
  add_terms(drivers_.velocity_terms(evaluated_.data()));
  project(v, right);
}

void Assembly::project_acceleration(const double* v, const double* a, double* right) {
  dimension_ == 2 ? evaluate_derivative<2>(v) : evaluate_derivative<3>(v);
  std::fill(multiplier_.begin() + quadratic_count_, multiplier_.end(), 0.0);
  add_terms(drivers_.acceleration_terms(evaluated_.data()));
  project(a, right);
}

/// right = -weight alpha Phi_q' (Phi_q x + multiplier_), Eq. (6), row by row.
void Assembly::project(const double* x, double* right) const {
  std::fill_n(right, variables_, 0.0);
  for (int row = 0; row < constraints_; ++row) {
    double sum = multiplier_[row];
    for (int k = row_start_[row]; k < row_start_[row + 1]; ++k) {
      sum += jacobian_[nonzero_place_[k]] * x[nonzero_column_[k]];
    }
    add_gradient(row, -weight_ * penalty_ * sum, right);
  }
}

/// multiplier_ = 2 u' . w', Eq. (7), or 2 u' . B w', for the quadratic constraints; the rest of
/// dPhi_q/dt v + dPhi_t/dt is the drivers'.
template <int kDimension>
void Assembly::evaluate_derivative(const double* v) {
  for (const Distance& distance : distances_) {
    double square = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      const double difference = v[distance.a + axis] - v[distance.b + axis];
      square += difference * difference;
    }
    multiplier_[distance.row] = 2.0 * square;
  }
  for (const Dot& dot : dots_) {
    double product = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      product += (v[dot.a + axis] - v[dot.b + axis]) * (v[dot.c + axis] - v[dot.d + axis]);
    }
    multiplier_[dot.row] = 2.0 * product;
  }
  evaluate_bilinear_derivative<kDimension>(v);
}

/// y = M x from the mass entries at the head of T's list.
void Assembly::multiply_mass(const double* x, double* y) const {
  for (int i = 0; i < variables_; ++i) y[i] = values_[i] * x[i];
  for (int k = variables_; k < mass_count_; ++k) {
    const int row = rows_[k] - 1, column = columns_[k] - 1;
    y[row] += values_[k] * x[column];
    y[column] += values_[k] * x[row];
  }
}

/// y += `factor` times the structural non-zeros of a row of Phi_q.
void Assembly::add_gradient(int row, double factor, double* y) const {
  for (int k = row_start_[row]; k < row_start_[row + 1]; ++k) {
    y[nonzero_column_[k]] += jacobian_[nonzero_place_[k]] * factor;
  }
}

/// multiplier_ += `terms`, which are those of the rows that depend on time.
void Assembly::add_terms(std::span<const double> terms) {
  for (std::size_t i = 0; i < terms.size(); ++i) multiplier_[drivers_.rows()[i]] += terms[i];
}

}  // namespace mbs::starting_sparse
