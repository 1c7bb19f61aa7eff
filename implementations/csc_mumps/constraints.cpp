// Phi, Phi_q and the velocity terms, along the lists that assembly_symbolic.cpp has made.
#include <algorithm>

#include "assembly.hpp"

namespace mbs::csc_mumps {

void Assembly::evaluate_constraints(const double* q_extended) {
  dimension_ == 2 ? evaluate_constraints_in<2>(q_extended) : evaluate_constraints_in<3>(q_extended);
  if (!linear_value_.empty()) evaluate_linear(q_extended);
  if (!drivers_.empty()) evaluated_.assign(q_extended, q_extended + evaluated_.size());
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
  if (!bilinears_.empty()) evaluate_bilinear_in<kDimension>(q, place, gradient);
}

template <int kDimension>
void Assembly::evaluate_bilinear_in(const double* q, const int* place, const Gradient* gradient) {
  for (const Bilinear& bilinear : bilinears_) {
    double product = 0.0;
    double of_a[kDimension] = {};  // B (r_c - r_d)
    double of_c[kDimension] = {};  // B' (r_a - r_b)
    for (int i = 0; i < kDimension; ++i) {
      const double first = q[bilinear.a + i] - q[bilinear.b + i];
      for (int j = 0; j < kDimension; ++j) {
        of_a[i] += bilinear.B[i][j] * (q[bilinear.c + j] - q[bilinear.d + j]);
        of_c[j] += bilinear.B[i][j] * first;
      }
      product += first * of_a[i];
    }
    for (int axis = 0; axis < kDimension; ++axis) {
      for (int slot = 0; slot < kPointsOfDot; ++slot) {
        jacobian_[*place++] =
            gradient[slot].of_second * of_a[axis] + gradient[slot].of_first * of_c[axis];
      }
    }
    phi_[bilinear.row] = product - bilinear.value;  // Eq. (7)
    gradient += kPointsOfDot;
  }
}

void Assembly::evaluate_linear(const double* q) {
  for (std::size_t i = 0; i < linear_value_.size(); ++i) {
    double sum = -linear_value_[i];
    for (int k = linear_start_[i]; k < linear_start_[i + 1]; ++k) {
      sum += linear_terms_[k].coefficient * q[linear_terms_[k].coordinate];
    }
    phi_[linear_row_ + i] = sum;  // Eq. (8)
  }
}

void Assembly::first_derivative(const double* v, double* result) const {
  std::fill(result, result + phi_.size(), 0.0);
  if (!drivers_.empty()) drivers_.add_velocity(evaluated_.data(), result);
  add_product(v, result);
}

void Assembly::second_derivative(const double* v, const double* a, double* result) const {
  dimension_ == 2 ? evaluate_squares<2>(v, result) : evaluate_squares<3>(v, result);
  std::fill(result + linear_row_, result + phi_.size(), 0.0);  // Eq. (8)
  if (!drivers_.empty()) drivers_.add_acceleration(evaluated_.data(), result);
  add_product(a, result);
}

/// result = dPhi_q/dt v, Eq. (7), of all but linear constraints.
template <int kDimension>
void Assembly::evaluate_squares(const double* v, double* result) const {
  for (const Distance& distance : distances_) {
    double square = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      const double edge = v[distance.first + axis] - v[distance.second + axis];
      square += edge * edge;
    }
    result[distance.row] = 2.0 * square;
  }
  for (const Dot& dot : dots_) {
    double product = 0.0;
    for (int axis = 0; axis < kDimension; ++axis) {
      product += (v[dot.a + axis] - v[dot.b + axis]) * (v[dot.c + axis] - v[dot.d + axis]);
    }
    result[dot.row] = 2.0 * product;
  }
  for (const Bilinear& bilinear : bilinears_) {
    double product = 0.0;
    for (int i = 0; i < kDimension; ++i) {
      for (int j = 0; j < kDimension; ++j) {
        product += bilinear.B[i][j] * (v[bilinear.a + i] - v[bilinear.b + i]) *
                   (v[bilinear.c + j] - v[bilinear.d + j]);
      }
    }
    result[bilinear.row] = 2.0 * product;
  }
}

}  // namespace mbs::csc_mumps
