// Phi and Phi_q, derivatives of Phi by time.
#pragma once

#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"

namespace mbs::csc_umfpack {

/// Phi and Phi_q in D dimensions. Rows and x are those of the layout, which it keeps; v and a are
/// laid out like x, with zeros for points at rest.
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
  /// y (m) = the first derivative of Phi by time at x, as if values were constant.
  void rates(const double* x, const double* v, double* y) const;
  /// y (m) = the second one, likewise.
  void second_rates(const double* x, const double* v, const double* a, double* y) const;
  /// y (n) -= Phi_q^T z, z (m).
  void subtract_transpose_product(const double* z, double* y) const;

 private:
  /// The rows of dots and bilinears, whose blocks start at J; returns where Phi goes on.
  double* evaluate_products(const double* x, double* Phi, double* J) const;
  /// Sum c_k x_k of a linear row, Eq. (8).
  [[nodiscard]] double sum(const JacobianLayout::Linear& row, const double* x) const;

  JacobianLayout layout_;
  std::vector<double> values_;
};

}  // namespace mbs::csc_umfpack
