// Products of M and Phi_q with vectors, and the forces: what right-hand sides are made of.
#include "assembly.hpp"

#include <algorithm>

namespace mbs::csc_mumps {

void Assembly::balance(const double* q, const double* v, const double* a, const double* weights,
                       double* right) {
  multiply_mass(a, right);
  if (!forces_.empty()) forces_.evaluate(q, v, right);
  if (!drivers_.empty()) drivers_.add_inertia(right);
  const int* start = jacobian_pattern_.start.data();
  const int* row = jacobian_pattern_.row.data();
  for (int j = 0; j < variables_; ++j) {
    double sum = right[j] - force_[j];
    for (int k = start[j]; k < start[j + 1]; ++k) sum += jacobian_[k] * weights[row[k]];
    right[j] = -quarter_ * sum;  // Eq. (3)
  }
}

void Assembly::add_product(const double* x, double* result) const {
  const int* start = jacobian_pattern_.start.data();
  const int* row = jacobian_pattern_.row.data();
  for (int j = 0; j < variables_; ++j) {
    const double x_j = x[j];
    for (int k = start[j]; k < start[j + 1]; ++k) result[row[k]] += jacobian_[k] * x_j;
  }
}

void Assembly::react(double factor, const double* weights, double* right) const {
  const int* start = jacobian_pattern_.start.data();
  const int* row = jacobian_pattern_.row.data();
  for (int j = 0; j < variables_; ++j) {
    double sum = 0.0;
    for (int k = start[j]; k < start[j + 1]; ++k) sum += jacobian_[k] * weights[row[k]];
    right[j] = -factor * sum;
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
