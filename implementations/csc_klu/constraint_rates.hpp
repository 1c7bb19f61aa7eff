// Derivatives of Phi by time.
#pragma once

#include <span>
#include <vector>

#include "equations.hpp"

namespace mbs::csc_klu {

/// First and second derivatives of Phi at the present q, v, a of an Equations, which has to outlive
/// this. Every result has m numbers, which stay until the next call.
template <int dim>
class ConstraintRates {
 public:
  using Result = std::span<const double>;

  explicit ConstraintRates(const Equations<dim>& equations)
      : equations_(equations), z_(equations.m, 0.0) {}

  /// Phi_q v + Phi_t.
  Result velocity() {
    const Equations<dim>& e = equations_;
    e.jacobian.rates(e.q.data(), e.v.data(), z_.data());  // Eq. (7)
    if (e.has_drivers) e.drivers.subtract_value_rates(z_.data());
    return z_;
  }

  /// Phi_q a + Phi-dot_q v + Phi-dot_t.
  Result acceleration() {
    const Equations<dim>& e = equations_;
    e.jacobian.second_rates(e.q.data(), e.v.data(), e.a.data(), z_.data());  // Eq. (7)
    if (e.has_drivers) e.drivers.subtract_value_accelerations(z_.data());
    return z_;
  }

  /// Phi-dot_q v, without drivers.
  Result velocity_term() {
    equations_.jacobian.velocity_term(equations_.v.data(), z_.data());
    return z_;
  }

 private:
  const Equations<dim>& equations_;
  std::vector<double> z_;  ///< m
};

}  // namespace mbs::csc_klu
