// T along the schedule that tangent_symbolic.cpp has made.
#include "tangent.hpp"

#include <cmath>

namespace mbs::csc_mumps {

bool Tangent::evaluate() {
  const double* jacobian = assembly_.jacobian().data();
  for (std::size_t t = 0; t < target_.size(); ++t) {
    double sum = 0.0;
    for (int k = product_start_[t]; k < product_start_[t + 1]; ++k) {
      sum += jacobian[left_[k]] * jacobian[right_[k]];
    }
    update_[target_[t]] = sum;
  }
  for (std::size_t k = 0; k < values_.size(); ++k) {
    values_[k] = constant_[k] + factor_ * update_[k];  // Eq. (5)
  }
  const Forces& forces = assembly_.forces();
  if (!forces.empty()) forces.add_to_tangent(force_places_.data(), values_.data());
  double trace = 0.0;  // squares of Phi_q and g are in it, so nothing else is worse
  for (int j = 0; j < variables_; ++j) trace += values_[pattern_.start[j]];
  return std::isfinite(trace);
}

}  // namespace mbs::csc_mumps
