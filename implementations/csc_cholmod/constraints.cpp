// Straight loops over the flat arrays of the lowered constraints.
#include "constraints.hpp"

#include <algorithm>
#include <cstddef>

namespace mbs::csc_cholmod {
namespace {

/// result (rows) += the linear rows of Phi_q times x. Inlined: a call at the end of a vectorised
/// function would leave the upper halves of vector registers set (GCC), and CHOLMOD's scalar code
/// is slower then.
[[gnu::always_inline]] inline void add_linear_product(const LinearBlock& linear, const double* x,
                                                      double* __restrict result) {
  result += linear.first_row;
  for (int k = 0; k < linear.count; ++k) {
    double sum = result[k];
    for (int t = linear.start[k]; t < linear.start[k + 1]; ++t) {
      sum += linear.coefficient[t] * x[linear.column[t]];
    }
    result[k] = sum;
  }
}

}  // namespace

Constraints::Constraints(const LoweredConstraints& lowered)
    : lowered_(lowered),
      target_(lowered.target),
      phi_(lowered.rows()),
      values_(lowered.values()),
      pairs_(lowered.pairs.begin(), lowered.pairs.end()),
      forces_(2 * lowered.values() + lowered.linear.column.size()) {}

void Constraints::take(const double* q) {
  const DistanceBlock& distance = lowered_.distance;
  double* __restrict values = values_.data();
  const int* plus = distance.plus.data();
  const int* minus = distance.minus.data();
  const int elements = lowered_.dimension * distance.count;
#pragma GCC unroll 4  // else a third of the loop counts
  for (int e = 0; e < elements; ++e) values[e] = 2.0 * (q[plus[e]] - q[minus[e]]);  // Eq. (7)
  for (PairValues& block : pairs_) block.take(q);
}

void Constraints::evaluate_jacobian() {  // take() has written those of distances
  for (const PairValues& block : pairs_) block.write_jacobian(values_.data());
}

void Constraints::evaluate_phi(const double* q) {
  const DistanceBlock& distance = lowered_.distance;
  const double* __restrict values = values_.data();
  double* __restrict phi = phi_.data();
  const int elements = lowered_.dimension * distance.count;
  for (std::size_t k = 0; k < phi_.size(); ++k) phi[k] = -target_[k];
  for (int first = 0; first < elements; first += distance.count) {
    for (int k = 0; k < distance.count; ++k) {
      phi[k] += 0.25 * values[first + k] * values[first + k];  // Eq. (7); the factors are exact
    }
  }
  for (const PairValues& block : pairs_) block.add_products(1.0, phi);  // Eq. (7)
  add_linear_product(lowered_.linear, q, phi);                          // Eq. (8)
}

void Constraints::first_rate(const double* v, double* __restrict result) const {
  const DistanceBlock& distance = lowered_.distance;
  const double* values = values_.data();
  const int* plus = distance.plus.data();
  const int* minus = distance.minus.data();
  std::fill_n(result, lowered_.rows(), 0.0);
  for (int axis = 0; axis < lowered_.dimension; ++axis) {
    for (int k = 0; k < distance.count; ++k) result[k] += *values++ * (v[*plus++] - v[*minus++]);
  }
  for (const PairValues& block : pairs_) block.add_rates(v, result);
  add_linear_product(lowered_.linear, v, result);
}

void Constraints::second_rate(const double* v, const double* a, double* __restrict result) {
  first_rate(a, result);
  const DistanceBlock& distance = lowered_.distance;
  const int* plus = distance.plus.data();
  const int* minus = distance.minus.data();
  for (int axis = 0; axis < lowered_.dimension; ++axis) {
    for (int k = 0; k < distance.count; ++k) {
      const double difference = v[*plus++] - v[*minus++];
      result[k] += 2.0 * difference * difference;  // Eq. (7)
    }
  }
  for (PairValues& block : pairs_) {
    block.take(v);
    block.add_products(2.0, result);  // Eq. (7)
  }
}

void Constraints::multiply(const double* x) {
  const int count = lowered_.distance.count;
  const double* __restrict values = values_.data();
  double* __restrict plus = forces_.data();
  double* __restrict minus = plus + lowered_.values();
  int i = 0;
  for (int axis = 0; axis < lowered_.dimension; ++axis, i += count) {
    for (int k = 0; k < count; ++k) {
      const double force = values[i + k] * x[k];
      plus[i + k] = force;
      minus[i + k] = -force;
    }
  }
  for (const PairBlock& block : lowered_.pairs) {
    for (int row : block.row) {
      const double force = values[i] * x[row];
      plus[i] = force;
      minus[i++] = -force;
    }
  }
  const LinearBlock& linear = lowered_.linear;
  double* terms = minus + lowered_.values();
  for (std::size_t t = 0; t < linear.row.size(); ++t) {
    terms[t] = linear.coefficient[t] * x[linear.row[t]];
  }
}

void Constraints::multiply_pairs(double factor, double* products) const {
  const int count = lowered_.distance.count;
  const double* __restrict values = values_.data();
  double* __restrict plus = products;
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
  for (const PairBlock& block : lowered_.pairs) {
    for (int p = 0; p < block.products(); ++p) {
      const double product = factor * values[block.left[p]] * values[block.right[p]];
      *plus++ = product;
      *minus++ = -product;
    }
  }
}

}  // namespace mbs::csc_cholmod
