// Straight loops over the flat arrays of the lowered constraints.
#include "constraints.hpp"

namespace mbs::csc_cholmod {

Constraints::Constraints(const LoweredConstraints& lowered)
    : lowered_(lowered),
      phi_(lowered.rows()),
      values_(lowered.values()),
      u_(lowered.dot.a.size()),
      w_(lowered.dot.a.size()),
      forces_(2 * lowered.values() + lowered.linear.column.size()),
      products_(2 * lowered.products()) {}

void Constraints::dot_differences(const double* q) {
  const DotBlock& dot = lowered_.dot;
  for (std::size_t e = 0; e < u_.size(); ++e) {
    u_[e] = q[dot.a[e]] - q[dot.b[e]];
    w_[e] = q[dot.c[e]] - q[dot.d[e]];
  }
}

void Constraints::evaluate_jacobian(const double* q) {
  const DistanceBlock& distance = lowered_.distance;
  double* __restrict values = values_.data();
  const int* plus = distance.plus.data();
  const int* minus = distance.minus.data();
  const int elements = lowered_.dimension * distance.count;
  for (int e = 0; e < elements; ++e) values[e] = 2.0 * (q[plus[e]] - q[minus[e]]);

  const DotBlock& dot = lowered_.dot;
  values += elements;
  dot_differences(q);
  for (std::size_t i = 0; i < dot.source.size(); ++i) {
    values[i] = dot.of_u[i] * u_[dot.source[i]] + dot.of_w[i] * w_[dot.source[i]];
  }
}

void Constraints::evaluate_phi(const double* q) {
  const DistanceBlock& distance = lowered_.distance;
  const double* __restrict values = values_.data();
  double* __restrict phi = phi_.data();
  const int elements = lowered_.dimension * distance.count;
  for (int k = 0; k < distance.count; ++k) phi[k] = -distance.squared_length[k];
  for (int first = 0; first < elements; first += distance.count) {
    for (int k = 0; k < distance.count; ++k) {
      phi[k] += 0.25 * values[first + k] * values[first + k];  // Eq. (7); the factors are exact
    }
  }

  const DotBlock& dot = lowered_.dot;
  phi += distance.count;
  for (int k = 0; k < dot.count; ++k) phi[k] = -dot.target[k];
  for (std::size_t e = 0, k = 0; e < u_.size(); ++e) {
    phi[k] += u_[e] * w_[e];  // Eq. (7)
    if (++k == static_cast<std::size_t>(dot.count)) k = 0;
  }

  const LinearBlock& linear = lowered_.linear;
  phi += dot.count;
  for (int k = 0; k < linear.count; ++k) {
    double sum = -linear.target[k];
    for (int t = linear.start[k]; t < linear.start[k + 1]; ++t) {
      sum += linear.coefficient[t] * q[linear.column[t]];  // Eq. (8)
    }
    phi[k] = sum;
  }
}

void Constraints::velocity_terms(const double* v, double factor, double* __restrict result) {
  const DistanceBlock& distance = lowered_.distance;
  const int* plus = distance.plus.data();
  const int* minus = distance.minus.data();
  const double twice = 2.0 * factor;  // Eq. (7)
  for (int k = 0; k < lowered_.rows(); ++k) result[k] = 0.0;
  for (int axis = 0; axis < lowered_.dimension; ++axis) {
    for (int k = 0; k < distance.count; ++k) {
      const double difference = v[*plus++] - v[*minus++];
      result[k] += twice * difference * difference;
    }
  }
  const DotBlock& dot = lowered_.dot;
  dot_differences(v);
  for (std::size_t e = 0, k = 0; e < u_.size(); ++e) {
    result[distance.count + k] += twice * u_[e] * w_[e];
    if (++k == static_cast<std::size_t>(dot.count)) k = 0;
  }
}

void Constraints::multiply(const double* x) {
  const int count = lowered_.distance.count;
  const int size = lowered_.values();
  const double* __restrict values = values_.data();
  double* __restrict plus = forces_.data();
  double* __restrict minus = plus + size;
  int i = 0;
  for (int axis = 0; axis < lowered_.dimension; ++axis, i += count) {
    for (int k = 0; k < count; ++k) {
      const double force = values[i + k] * x[k];
      plus[i + k] = force;
      minus[i + k] = -force;
    }
  }
  x += count;
  for (int row : lowered_.dot.row) {
    const double force = values[i] * x[row];
    plus[i] = force;
    minus[i++] = -force;
  }
  x += lowered_.dot.count;
  const LinearBlock& linear = lowered_.linear;
  double* terms = plus + 2 * size;
  for (std::size_t t = 0; t < linear.row.size(); ++t) {
    terms[t] = linear.coefficient[t] * x[linear.row[t]];
  }
}

void Constraints::multiply_pairs(double factor) {
  const int count = lowered_.distance.count;
  const double* __restrict values = values_.data();
  double* __restrict plus = products_.data();
  double* __restrict minus = plus + lowered_.products();
  const int elements = lowered_.dimension * count;
  for (int first = 0; first < elements; first += count) {
    for (int second = first; second < elements; second += count) {
      for (int k = 0; k < count; ++k) {
        const double product = factor * values[first + k] * values[second + k];
        plus[k] = product;
        minus[k] = -product;
      }
      plus += count;
      minus += count;
    }
  }
  const DotBlock& dot = lowered_.dot;
  for (std::size_t p = 0; p < dot.left.size(); ++p) {
    const double product = factor * values[dot.left[p]] * values[dot.right[p]];
    plus[p] = product;
    minus[p] = -product;
  }
}

}  // namespace mbs::csc_cholmod
