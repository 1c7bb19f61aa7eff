// Points and values that are known functions of time, and what they add to the equations.
#pragma once

#include <vector>

#include "driver_pattern.hpp"
#include "jacobian.hpp"

namespace mbs::csc_klu {

/// The drivers of a DriverPattern at one instant; it and the JacobianPattern have to outlive this.
template <int dim>
class Drivers {
 public:
  Drivers(const DriverPattern<dim>& pattern, const JacobianPattern<dim>& jacobian_pattern);

  [[nodiscard]] bool any() const { return !pattern_.points.empty() || !pattern_.values.empty(); }
  /// Takes what is driven at time t (s); writes driven points to the extended positions q and
  /// velocities v.
  void sample(double t, double* q, double* v);
  /// phi (m) -= driven values, which the Jacobian took as zero.
  void subtract_values(double* phi) const;
  /// Writes the velocity, or acceleration, of driven points to the extended x.
  void place_rates(double* x) const { place(rates_, x); }
  void place_accelerations(double* x) const { place(accelerations_, x); }
  /// z (m) -= first, or second, derivatives of driven values.
  void subtract_value_rates(double* z) const { subtract_values(rates_, z); }
  void subtract_value_accelerations(double* z) const { subtract_values(accelerations_, z); }
  /// right (n) -= factor times driven mass times acceleration.
  void subtract_inertia(double factor, double* right) const;
  /// y (n) -= factor Phi_q^T Phi_t, at the positions q that the Jacobian was evaluated at.
  void subtract_rates(const Jacobian<dim>& jacobian, const double* q, double factor, double* y) {
    subtract(jacobian, q, rates_, factor, y);
  }
  /// The same with what Phi-dot_q v + Phi-dot_t has beyond Jacobian::velocity_term().
  void subtract_accelerations(const Jacobian<dim>& jacobian, const double* q, double factor,
                              double* y) {
    subtract(jacobian, q, accelerations_, factor, y);
  }

 private:
  /// First or second derivatives by time, laid out as DriverPattern says.
  struct Derivatives {
    std::vector<double> points, values;
  };

  void subtract(const Jacobian<dim>& jacobian, const double* q, const Derivatives& derivatives,
                double factor, double* y);
  void place(const Derivatives& derivatives, double* x) const;
  void subtract_values(const Derivatives& derivatives, double* z) const;

  const DriverPattern<dim>& pattern_;
  const JacobianPattern<dim>& jacobian_pattern_;
  std::vector<double> values_;  ///< driven values
  Derivatives rates_, accelerations_;
  std::vector<double> z_;  ///< one for each row of the pattern; what its Jacobian blocks multiply
};

}  // namespace mbs::csc_klu
