// Loops over runs: one axis of all constraints after the other.
#include "pair_values.hpp"

#include <algorithm>
#include <cstddef>

namespace mbs::csc_cholmod {

PairValues::PairValues(const PairBlock& block)
    : block_(block), u_(block.a.size()), w_(block.a.size()) {
  if (block.matrix.empty()) return;
  Bw_.resize(u_.size());
  Btu_.resize(u_.size());
}

void PairValues::take(const double* x) {
  for (std::size_t e = 0; e < u_.size(); ++e) {
    u_[e] = x[block_.a[e]] - x[block_.b[e]];
    w_[e] = x[block_.c[e]] - x[block_.d[e]];
  }
  if (!block_.matrix.empty()) multiply_matrix();
}

void PairValues::multiply_matrix() {
  const int count = block_.count;
  const double* B = block_.matrix.data();
  std::fill(Bw_.begin(), Bw_.end(), 0.0);
  std::fill(Btu_.begin(), Btu_.end(), 0.0);
  for (int i = 0; i < block_.dimension; ++i) {
    for (int j = 0; j < block_.dimension; ++j, B += count) {
      for (int k = 0; k < count; ++k) {
        Bw_[i * count + k] += B[k] * w_[j * count + k];
        Btu_[j * count + k] += B[k] * u_[i * count + k];
      }
    }
  }
}

void PairValues::write_jacobian(double* all_values) const {
  const double* of_u = Btu();
  const double* of_w = Bw();
  double* __restrict values = all_values + block_.first.value;
  for (std::size_t i = 0; i < block_.source.size(); ++i) {
    const int source = block_.source[i];
    values[i] = block_.of_u[i] * of_u[source] + block_.of_w[i] * of_w[source];  // Eq. (7)
  }
}

void PairValues::add_products(double factor, double* result) const {
  const double* of_a = Bw();
  const double* u = u_.data();
  double* __restrict rows = result + block_.first.row;
  for (int axis = 0; axis < block_.dimension; ++axis) {
    for (int k = 0; k < block_.count; ++k) rows[k] += factor * *u++ * *of_a++;
  }
}

void PairValues::add_rates(const double* v, double* result) const {
  const double* of_u = Btu();
  const double* of_w = Bw();
  double* __restrict rows = result + block_.first.row;
  for (int e = 0, axis = 0; axis < block_.dimension; ++axis) {
    for (int k = 0; k < block_.count; ++k, ++e) {
      rows[k] += of_w[e] * (v[block_.a[e]] - v[block_.b[e]]) +  // Eq. (7)
                 of_u[e] * (v[block_.c[e]] - v[block_.d[e]]);
    }
  }
}

}  // namespace mbs::csc_cholmod
