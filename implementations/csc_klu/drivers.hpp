// Points and values that are known functions of time, and what they add to the equations.
#pragma once

#include <vector>

#include "driver_pattern.hpp"

namespace mbs::csc_klu {

/// The drivers of a DriverPattern, which has to outlive this, at one instant.
template <int dim>
class Drivers {
 public:
  explicit Drivers(const DriverPattern<dim>& pattern);

  [[nodiscard]] bool any() const { return !pattern_.points.empty() || !pattern_.values.empty(); }
  /// Takes what is driven at time t (s); writes driven points to the extended positions q,
  /// velocities v and accelerations a.
  void sample(double t, double* q, double* v, double* a);
  /// z (m) -= driven values, which the Jacobian took as zero, or their derivatives by time.
  void subtract_values(double* z) const { subtract(values_, z); }
  void subtract_value_rates(double* z) const { subtract(rates_, z); }
  void subtract_value_accelerations(double* z) const { subtract(accelerations_, z); }
  /// right (n) -= factor times driven mass times acceleration, which is in the extended a.
  void subtract_inertia(double factor, const double* a, double* right) const;

 private:
  void subtract(const std::vector<double>& values, double* z) const;

  const DriverPattern<dim>& pattern_;
  std::vector<double> values_, rates_, accelerations_;  ///< of driven values
};

}  // namespace mbs::csc_klu
