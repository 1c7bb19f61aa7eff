// Phi, Phi_q and the products with it.
#pragma once

#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"

namespace mbs::csc_umfpack {

/// Phi and Phi_q in D dimensions. Rows and x are those of the layout, which it keeps.
template <int D>
class Jacobian {
 public:
  Jacobian(const Model& model, const PointLayout& points)
      : layout_(model, points), values_(layout_.blocks.size() * D) {}

  [[nodiscard]] const JacobianLayout& layout() const { return layout_; }
  [[nodiscard]] const double* values() const { return values_.data(); }

  /// Gives the constraint of a row another value.
  void set_value(int row, double value) { layout_.value(row) = value; }

  /// Phi (m) and Phi_q at x.
  void evaluate(const double* x, double* Phi);
  /// y (m) += factor Phi_q x, x (n).
  void add_product(const double* x, double factor, double* y) const;
  /// y (m) += factor times what velocities v alone give of the second derivative of Phi; v is laid
  /// out like x of evaluate(), with zeros for points at rest.
  void add_velocity_term(const double* v, double factor, double* y) const;
  /// y (n) -= Phi_q^T z, z (m).
  void subtract_transpose_product(const double* z, double* y) const;

 private:
  /// The rows of dots and bilinears, whose blocks start at J; returns where Phi goes on.
  double* evaluate_products(const double* x, double* Phi, double* J) const;

  JacobianLayout layout_;
  std::vector<double> values_;
};

}  // namespace mbs::csc_umfpack
