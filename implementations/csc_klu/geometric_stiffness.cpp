// The geometric stiffness of the constraints, Eq. (16): its values, and products with it.
#include "geometric_stiffness.hpp"

#include <cstddef>

namespace mbs::csc_klu {

GeometricStiffness::GeometricStiffness(const std::vector<HessianEntry>& entries,
                                       const Pattern& pattern, double weight)
    : entries_(entries), weight_(weight) {
  for (const HessianEntry& entry : entries) at_.push_back(pattern.offset(entry.row, entry.col));
  if (any()) g_.assign(entries.back().constraint + 1, 0.0);
}

void GeometricStiffness::evaluate(double penalty, std::span<const double> lambda,
                                  std::span<const double> phi) {
  for (std::size_t i = 0; i < g_.size(); ++i) {
    g_[i] = weight_ * (lambda[i] + penalty * phi[i]);  // Eq. (16)
  }
}

void GeometricStiffness::reset(std::span<const double> constant, std::span<double> values) const {
  for (const int at : at_) values[at] = constant[at];
}

void GeometricStiffness::add(std::span<double> values) const {
  const int* at = at_.data();
  for (const HessianEntry& entry : entries_) {
    values[*at++] += g_[entry.constraint] * entry.value;  // Eq. (16)
  }
}

void GeometricStiffness::add_product(const double* x, double* y) const {
  for (const HessianEntry& entry : entries_) {
    y[entry.row] += g_[entry.constraint] * entry.value * x[entry.col];  // Eq. (16)
  }
}

}  // namespace mbs::csc_klu
