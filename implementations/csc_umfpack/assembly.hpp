// The values of M, Phi_q and T on their patterns, and everything that is evaluated in a step.
#pragma once

#include <span>
#include <vector>

#include "mbs/model.hpp"
#include "symbolic.hpp"

namespace mbs::csc_umfpack {

/// M, both triangles; positions with a stored zero are entries like any other.
class MassMatrix {
 public:
  explicit MassMatrix(const Model& model);

  [[nodiscard]] const SparsityPattern& pattern() const { return pattern_; }
  [[nodiscard]] std::span<const double> values() const { return values_; }

  /// y = scale (Q - M x).
  void residual(const double* x, const double* Q, double scale, double* y) const;
  /// y = M x and y2 = M x2, reading M once.
  void multiply(const double* x, const double* x2, double* y, double* y2) const;

 private:
  SparsityPattern pattern_;
  std::vector<double> values_;
};

/// Phi and Phi_q in D dimensions. Rows and x are those of the layout, which it keeps.
template <int D>
class Jacobian {
 public:
  explicit Jacobian(const Model& model) : layout_(model), values_(layout_.blocks.size() * D) {}

  [[nodiscard]] const JacobianLayout& layout() const { return layout_; }
  [[nodiscard]] const double* values() const { return values_.data(); }

  /// Phi (m) and Phi_q at x.
  void evaluate(const double* x, double* Phi);
  /// y = factor (dPhi_q/dt v) (m) for velocities v, laid out like x with zeros for fixed points.
  void velocity_term(const double* v, double factor, double* y) const;
  /// y (n) -= Phi_q^T z, z (m).
  void subtract_transpose_product(const double* z, double* y) const;

 private:
  /// The rows of general dot constraints, whose blocks start at J; returns where Phi goes on.
  double* evaluate_dots(const double* x, double* Phi, double* J) const;

  JacobianLayout layout_;
  std::vector<double> values_;
};

/// T by Eq. (5), both triangles. What does not change is written once, at construction: the entries
/// of M that no dot constraint reaches, and the share of the linear constraints.
template <int D>
class Tangent {
 public:
  /// `factor` is (Delta t^2 / 4) alpha.
  Tangent(const MassMatrix& mass, const JacobianLayout& layout, double factor);

  [[nodiscard]] const SparsityPattern& pattern() const { return schedule_.pattern; }
  [[nodiscard]] const double* values() const { return values_.data(); }

  void update(const Jacobian<D>& jacobian);

 private:
  TangentSchedule<D> schedule_;
  double factor_;
  std::vector<double> values_;
  std::vector<double> constant_;  ///< D x D for every block of the schedule, row by row
};

}  // namespace mbs::csc_umfpack
