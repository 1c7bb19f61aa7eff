// The constraints of a Model, lowered to flat arrays, and their evaluation.
#pragma once

#include <vector>

#include "bilinear.hpp"
#include "columns.hpp"
#include "matrices.hpp"
#include "mbs/model.hpp"
#include "points.hpp"

namespace mbs::ublas_sparse {

/// Eqs. (7) and (8) at the positions and velocities of `points`, without what drivers add to the
/// derivatives by time (drivers.hpp).
class Constraints {
 public:
  Constraints(const Model& model, const Points& points);

  /// Phi_q (m x n) with every position in place: the constant coefficients of Eq. (8), else zeros.
  [[nodiscard]] SparseMatrix jacobian_storage(const Points& points) const;

  /// Sets s of the constraint at `row` of Phi.
  void set_value(int row, double s) { values_[row] = s; }

  /// Phi (m), written.
  void evaluate(const Points& points, Vector& Phi) const;
  /// Writes the varying entries of Phi_q, made by jacobian_storage(), through Phi_q(i, j) = value.
  void evaluate_jacobian(const Points& points, SparseMatrix& Phi_q) const;
  /// The part of Phi'' by velocities alone (m, m^2/s^2), written.
  void evaluate_acceleration_term(const Points& points, Vector& term) const;

 private:
  struct Distance {
    int row, a, b;  // first coordinates
  };
  struct Linear {
    int row;
    std::vector<LinearConstraint::Term> terms;
  };

  void add_dots(const Model& model, const Points& points);

  std::vector<double> values_;  // m, s of Eqs. (7) and (8)
  std::vector<Distance> distances_;
  std::vector<Quadratic> dots_;
  std::vector<Column> dot_columns_;
  BilinearConstraints bilinears_;
  std::vector<Linear> linears_;
};

}  // namespace mbs::ublas_sparse
