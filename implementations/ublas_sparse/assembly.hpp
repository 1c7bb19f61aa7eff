// The constraints of a Model, lowered to flat arrays, and their evaluation.
#pragma once

#include <span>
#include <vector>

#include "matrices.hpp"
#include "mbs/model.hpp"

namespace mbs::ublas_sparse {

/// Eqs. (7) and (8) at the position given to move_to(). Points are looked up in q followed by the
/// coordinates of the fixed points, so that no constraint asks which kind its points are.
class Constraints {
 public:
  explicit Constraints(const Model& model);

  /// Phi_q (m x n) with every position in place: the constant coefficients of Eq. (8), else zeros.
  [[nodiscard]] SparseMatrix jacobian_storage() const;

  /// Takes q (n, m) as the position that the evaluations below use.
  void move_to(std::span<const double> q);
  /// Phi (m), written.
  void evaluate(Vector& Phi) const;
  /// Writes the varying entries of Phi_q, made by jacobian_storage(), through Phi_q(i, j) = value.
  void evaluate_jacobian(SparseMatrix& Phi_q) const;
  /// The term of Phi'' free of accelerations (m, m^2/s^2), written, at velocities v (n, m/s).
  void evaluate_acceleration_term(const Vector& v, Vector& term);

 private:
  struct Distance {
    int row, a, b;  // first coordinates
    double value;
  };
  struct Dot {
    int row, a, b, c, d;
    double value;
    int columns_begin, columns_end;  // in dot_columns_
  };
  /// Phi_q(row, point + k) = by_cd (r_c - r_d)_k + by_ab (r_a - r_b)_k, distinct free points.
  struct DotColumn {
    int point;
    double by_cd, by_ab;
  };
  struct Linear {
    int row;
    double value;
    std::vector<LinearConstraint::Term> terms;
  };

  void add_dot(const Dot& dot);

  int variables_, constraints_, dimension_;
  std::vector<Distance> distances_;
  std::vector<Dot> dots_;
  std::vector<DotColumn> dot_columns_;
  std::vector<Linear> linears_;
  std::vector<double> position_;  // q, then fixed points
  std::vector<double> velocity_;  // v, then zeros
};

}  // namespace mbs::ublas_sparse
