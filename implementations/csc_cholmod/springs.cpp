// Loops over all springs and laws, one axis after the other.
#include "springs.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::csc_cholmod {

Springs::Springs(const SpringBlock& block, const std::vector<ScaledLaw>& laws,
                 const StepSettings& settings)
    : block_(block),
      laws_(laws),
      half_(settings.step / 2.0),
      quarter_(half_ * half_),
      e_(block.plus.size()),
      force_(block.count),
      along_(block.count),
      across_(block.count),
      square_(block.count),
      product_(block.count) {}

void Springs::evaluate(const double* q, const double* u) {
  const int count = block_.count;
  std::fill(square_.begin(), square_.end(), 0.0);
  std::fill(product_.begin(), product_.end(), 0.0);
  for (int i = 0, axis = 0; axis < block_.dimension; ++axis) {
    for (int k = 0; k < count; ++k, ++i) {
      e_[i] = q[block_.plus[i]] - q[block_.minus[i]];
      square_[k] += e_[i] * e_[i];
      product_[k] += e_[i] * (u[block_.plus[i]] - u[block_.minus[i]]);
    }
  }
  const auto set = [&](int k, const auto& force_at) {
    const double length = std::sqrt(square_[k]);
    const double inverse = length > 0.0 ? 1.0 / length : 0.0;
    const ElementForce f = force_at(length, inverse * product_[k]);
    force_[k] = -(f.spring + f.damper);  // Eqs. (11), (18)
    across_[k] = std::max(0.0, length > 0.0 ? f.spring * inverse : f.stiffness);
    along_[k] = f.damping + f.stiffness - across_[k];
    square_[k] = inverse;
  };
  const int springs = static_cast<int>(block_.stiffness.size());
  for (int k = 0; k < springs; ++k) {
    const double stiffness = quarter_ * block_.stiffness[k];
    const double damping = half_ * block_.damping[k];
    set(k, [&](double length, double rate) {
      return ElementForce{stiffness * (length - block_.length[k]), damping * rate, stiffness,
                          damping};
    });
  }
  for (int k = springs; k < count; ++k) {
    set(k, [&](double length, double rate) { return laws_[k - springs].at(length, rate); });
  }
  for (int i = 0, axis = 0; axis < block_.dimension; ++axis) {
    for (int k = 0; k < count; ++k) e_[i++] *= square_[k];
  }
}

double* Springs::loads(double* __restrict summands) const {
  const double* e = e_.data();
  for (int axis = 0; axis < block_.dimension; ++axis) {
    for (int k = 0; k < block_.count; ++k) *summands++ = force_[k] * *e++;  // Eqs. (11), (18)
  }
  return summands;
}

double* Springs::tangent(double* __restrict products) const {
  const int count = block_.count;
  const double* e = e_.data();
  for (int i = 0; i < block_.dimension; ++i) {
    for (int j = i; j < block_.dimension; ++j, products += count) {
      const double diagonal = i == j ? 1.0 : 0.0;
      for (int k = 0; k < count; ++k) {
        products[k] = diagonal * across_[k] + along_[k] * e[i * count + k] * e[j * count + k];
      }
    }
  }
  return products;
}

}  // namespace mbs::csc_cholmod
