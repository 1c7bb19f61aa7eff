// Derivatives of Phi by time, all at once or the part that is free of the unknown.
#pragma once

#include <algorithm>
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
      : equations_(equations), moved_(equations.q.size(), 0.0), z_(equations.m, 0.0) {}

  /// Phi_q v + Phi_t.
  Result velocity() {
    std::ranges::fill(z_, 0.0);
    equations_.jacobian.add_rates(equations_.q.data(), equations_.v.data(), z_.data());  // Eq. (7)
    if (equations_.has_drivers) equations_.drivers.subtract_value_rates(z_.data());
    return z_;
  }

  /// Phi_t.
  Result partial_velocity() {
    std::ranges::fill(z_, 0.0);
    if (!equations_.has_drivers) return z_;
    std::fill_n(moved_.begin(), equations_.n, 0.0);
    equations_.drivers.place_rates(moved_.data());
    equations_.jacobian.add_rates(equations_.q.data(), moved_.data(), z_.data());  // Eq. (7)
    equations_.drivers.subtract_value_rates(z_.data());
    return z_;
  }

  /// Phi_q a + Phi-dot_q v + Phi-dot_t.
  Result acceleration() {
    evaluate_velocity_term();
    std::ranges::copy(equations_.a, moved_.begin());
    add_accelerations();
    return z_;
  }

  /// Phi-dot_q v + Phi-dot_t.
  Result partial_acceleration() {
    evaluate_velocity_term();
    if (!equations_.has_drivers) return z_;
    std::fill_n(moved_.begin(), equations_.n, 0.0);
    add_accelerations();
    return z_;
  }

 private:
  void evaluate_velocity_term() {
    std::ranges::fill(z_, 0.0);
    equations_.jacobian.velocity_term(equations_.v.data(), 1.0, z_.data());
  }

  void add_accelerations() {
    if (equations_.has_drivers) equations_.drivers.place_accelerations(moved_.data());
    equations_.jacobian.add_rates(equations_.q.data(), moved_.data(), z_.data());  // Eq. (7)
    if (equations_.has_drivers) equations_.drivers.subtract_value_accelerations(z_.data());
  }

  const Equations<dim>& equations_;
  std::vector<double> moved_;  ///< extended; velocities or accelerations
  std::vector<double> z_;      ///< m
};

}  // namespace mbs::csc_klu
