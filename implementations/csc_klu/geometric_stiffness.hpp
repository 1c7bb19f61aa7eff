// The geometric stiffness of the constraints, Eq. (16): its values, and products with it.
#pragma once

#include <span>
#include <vector>

#include "hessians.hpp"
#include "storage.hpp"

namespace mbs::csc_klu {

/// dt^2/4 times the sum of Eq. (16). It is what the last evaluate() found until the next one.
///
///   stiffness.evaluate(penalty, lambda, phi);  // g
///   stiffness.add(values);                     // into a matrix on the pattern
///   stiffness.add_product(x, y);               // y += (dt^2/4 sum) x, for Eq. (15)
class GeometricStiffness {
 public:
  /// `entries` have to outlive this, have to be in `pattern`, and may be none; `weight` is dt^2/4.
  GeometricStiffness(const std::vector<HessianEntry>& entries, const Pattern& pattern,
                     double weight);

  [[nodiscard]] bool any() const { return !entries_.empty(); }
  /// Takes g = lambda + penalty phi; both in the order of JacobianPattern.
  void evaluate(double penalty, std::span<const double> lambda, std::span<const double> phi);
  /// Copies `constant` to `values` wherever add() adds; both have the entries of the pattern.
  void reset(std::span<const double> constant, std::span<double> values) const;
  void add(std::span<double> values) const;
  /// y (n) += product with x (n).
  void add_product(const double* x, double* y) const;

 private:
  const std::vector<HessianEntry>& entries_;
  const double weight_;    ///< dt^2/4, s^2
  std::vector<int> at_;    ///< offset of each entry in the pattern
  std::vector<double> g_;  ///< of the constraints with entries, and those before, times dt^2/4
};

}  // namespace mbs::csc_klu
