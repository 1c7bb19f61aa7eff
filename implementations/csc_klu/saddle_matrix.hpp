// The values of the saddle-point matrix of Eqs. (12) and (14).
#pragma once

#include <span>
#include <vector>

#include "forces.hpp"
#include "geometric_stiffness.hpp"
#include "jacobian.hpp"
#include "saddle_pattern.hpp"

namespace mbs::csc_klu {

/// Factors s for the rows and columns of multipliers, by which Phi_q gets the size of M: powers of
/// two, so that they round nothing. Without them pivots, and backward errors, depend on units. By M
/// and the Phi_q that `jacobian` has (m, in the order of JacobianPattern).
template <int dim>
[[nodiscard]] std::vector<double> multiplier_scales(const Model& model,
                                                    const JacobianPattern<dim>& pattern,
                                                    const Jacobian<dim>& jacobian);

/// [T_0 Phi_q^T s; s Phi_q -s eps s], both triangles. M, s eps s and linear constraints are written
/// once, here; a pass rewrites the Jacobian's blocks and what springs and Eq. (16) touch.
template <int dim>
class SaddleMatrix {
 public:
  /// `pattern` has to outlive this; `scales` are s.
  SaddleMatrix(const SaddlePattern<dim>& pattern, const Model& model, double epsilon,
               const std::vector<double>& scales);

  /// Updates the values for a new Phi_q.
  void assemble(const Jacobian<dim>& jacobian);
  /// Updates T_0 = M + dt/2 C + dt^2/4 K.
  void assemble(const Forces<dim>& forces) {
    pattern_.shares.add(forces, mass_.data(), values_.data());  // Eq. (12)
  }
  /// With Eq. (16): first this, then springs, then add().
  void reset(const GeometricStiffness& stiffness) { stiffness.reset(mass_, values_); }
  void add(const GeometricStiffness& stiffness) { stiffness.add(values_); }

  [[nodiscard]] std::span<const double> values() const { return values_; }

 private:
  const SaddlePattern<dim>& pattern_;
  std::vector<double> mass_;          ///< over the whole pattern
  std::vector<double> block_scales_;  ///< s of each block of the pattern
  std::vector<double> values_;
};

}  // namespace mbs::csc_klu
