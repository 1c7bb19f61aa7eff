// The numerical evaluations, along the lists that assembly_symbolic.cpp has made.
#include "assembly.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::csc_mumps {

void Assembly::evaluate_constraints(const double* q_extended) {
  dimension_ == 2 ? evaluate_constraints_in<2>(q_extended) : evaluate_constraints_in<3>(q_extended);
  for (std::size_t i = 0; i < linear_value_.size(); ++i) {
    double sum = -linear_value_[i];
    for (int k = linear_start_[i]; k < linear_start_[i + 1]; ++k) {
      sum += linear_terms_[k].coefficient * q_extended[linear_terms_[k].coordinate];
    }
    phi_[linear_row_ + i] = sum;  // Eq. (8)
  }
}

template <int kDimension>
void Assembly::evaluate_constraints_in(const double* q) {
  const int* place = write_order_.data();
  double* jacobian = jacobian_.data();
  for (const Distance& distance : distances_) {
    double square = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      const double edge = q[distance.first + axis] - q[distance.second + axis];
      square += edge * edge;
      jacobian[*place++] = 2.0 * edge;
      jacobian[*place++] = -2.0 * edge;
    }
    phi_[distance.row] = square - distance.value;  // Eq. (7)
  }
  const Gradient* gradient = gradients_.data();
  for (const Dot& dot : dots_) {
    double product = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      const double first = q[dot.a + axis] - q[dot.b + axis];
      const double second = q[dot.c + axis] - q[dot.d + axis];
      product += first * second;
      for (int slot = 0; slot < kPointsOfDot; ++slot) {
        jacobian[*place++] = gradient[slot].of_second * second + gradient[slot].of_first * first;
      }
    }
    phi_[dot.row] = product - dot.value;  // Eq. (7)
    gradient += kPointsOfDot;
  }
}

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
  double trace = 0.0;  // squares of Phi_q are in it, so nothing else can be worse
  for (int j = 0; j < variables_; ++j) trace += tangent_[pattern_.start[j]];
  return std::isfinite(trace);
}

void Assembly::newton_right(const double* acceleration, const double* lambda, double* right) {
  for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] = lambda[i] + penalty_ * phi_[i];
  multiply_mass(acceleration, right);
  for (int j = 0; j < variables_; ++j) {
    double sum = right[j] - force_[j];
    for (int k = column_start_[j]; k < column_start_[j + 1]; ++k) {
      sum += jacobian_[k] * weights_[row_[k]];
    }
    right[j] = -quarter_ * sum;  // Eq. (3)
  }
}

void Assembly::velocity_right(const double* velocity, double* right) const {
  multiply_mass(velocity, right);  // Eq. (6)
}

void Assembly::acceleration_right(const double* acceleration, const double* v_extended,
                                  double* right) {
  dimension_ == 2 ? evaluate_weights_in<2>(v_extended) : evaluate_weights_in<3>(v_extended);
  std::fill(weights_.begin() + linear_row_, weights_.end(), 0.0);  // Eq. (8)
  multiply_mass(acceleration, right);
  const double factor = quarter_ * penalty_;
  for (int j = 0; j < variables_; ++j) {
    double sum = 0.0;
    for (int k = column_start_[j]; k < column_start_[j + 1]; ++k) {
      sum += jacobian_[k] * weights_[row_[k]];
    }
    right[j] -= factor * sum;  // Eq. (6)
  }
}

/// weights_ = dPhi_q/dt v of the dot constraints, Eq. (7).
template <int kDimension>
void Assembly::evaluate_weights_in(const double* v) {
  for (const Distance& distance : distances_) {
    double square = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      const double edge = v[distance.first + axis] - v[distance.second + axis];
      square += edge * edge;
    }
    weights_[distance.row] = 2.0 * square;
  }
  for (const Dot& dot : dots_) {
    double product = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      product += (v[dot.a + axis] - v[dot.b + axis]) * (v[dot.c + axis] - v[dot.d + axis]);
    }
    weights_[dot.row] = 2.0 * product;
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
