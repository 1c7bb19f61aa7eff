// The tangent matrix T of Eq. (5): rank-k update and matrix addition in one sweep, then C and K.
#pragma once

#include <span>
#include <vector>

#include "forces.hpp"
#include "geometric_stiffness.hpp"
#include "jacobian.hpp"
#include "tangent_pattern.hpp"

namespace mbs::csc_klu {

/// The tangent matrix T of Eq. (5), both triangles.
template <int dim>
class Tangent {
 public:
  /// T = base + factor Phi_q^T Phi_q, with base = mass_values() on `pattern`, which has to outlive
  /// this. Linear constraints are constant and join the base here.
  Tangent(const TangentPattern<dim>& pattern, std::vector<double> base, double factor);

  /// Updates the values for a new Phi_q.
  void assemble(const Jacobian<dim>& jacobian);
  /// Adds dt/2 C + dt^2/4 K; after every assemble(), if there are forces.
  void add(const Forces<dim>& forces) {
    pattern_.shares.add(forces, constant_.data(), values_.data());  // Eq. (5)
  }
  /// Adds the share of Eq. (16); after all else.
  void add(const GeometricStiffness& stiffness) { stiffness.add(values_); }

  [[nodiscard]] const Pattern& pattern() const { return pattern_.pattern; }
  [[nodiscard]] std::span<const double> values() const { return values_; }

 private:
  const TangentPattern<dim>& pattern_;
  double factor_;
  std::vector<double> constant_;  ///< M and the linear constraints, over the union pattern
  std::vector<double> values_;
};

}  // namespace mbs::csc_klu
