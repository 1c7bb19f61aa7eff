// Phi, Phi_q and what derivatives by time need, Phi_q stored dense.
#pragma once

#include <array>
#include <vector>

#include "drivers.hpp"
#include "layout.hpp"
#include "matrix.hpp"
#include "mbs/model.hpp"
#include "vector3.hpp"

namespace mbs::starting_dense {

/// The constraints as flat arrays. With n variables, m constraints and d coordinates of driven
/// points; coordinates and velocities are extended (see Layout).
class Constraints {
 public:
  Constraints(const Model& model, const Layout& layout);

  /// Evaluates phi() and the Jacobian, both ways round, at `q` (m).
  void evaluate(const Vector& q);
  /// Phi (m) at the coordinates of the last evaluate().
  [[nodiscard]] const Vector& phi() const { return phi_; }
  /// m x (n + d): behind Phi_q stand the derivatives by the coordinates of driven points.
  [[nodiscard]] const Matrix& Phi_q() const { return Phi_q_; }
  /// n x m.
  [[nodiscard]] const Matrix& Phi_q_transposed() const { return Phi_q_transposed_; }
  /// s of every constraint (m), the drivers' to overwrite.
  Vector& values() { return values_; }

  /// Phi_q_dot v + Phi_t_dot (m), with `v` in m/s.
  const Vector& second_derivative(const Vector& v, const Drivers& drivers);

 private:
  /// What stays of Eq. (7): where the points are, and which blocks of the Jacobian row its two
  /// differences go to, driven points included.
  struct Quadratic {
    int a, b, c, d;
    int blocks_begin, blocks_end;
  };

  void add_quadratic(const Layout& layout, const std::array<int, 4>& points);
  void add_linear(const LinearConstraint& constraint, int row);
  void evaluate_dot(int row, const Vector& q);
  void evaluate_bilinear(int row, const Matrix3& B, const Vector& q);
  void evaluate_linear(const Vector& q);

  const int dimension_, variables_;
  const int dots_;                     ///< rows 0, 1, ... of Phi
  std::vector<Quadratic> quadratics_;  ///< dot, then bilinear constraints
  std::vector<Share> blocks_;          ///< Phi_q at one point: ab (r_c - r_d) + cd (r_a - r_b)
  std::vector<Matrix3> bilinear_;      ///< B of each bilinear row
  std::vector<LinearConstraint::Term> terms_;  ///< of all linear rows, one row after another
  std::vector<int> terms_end_;                 ///< for each linear row

  Vector values_;
  Vector phi_;
  Matrix Phi_q_;  ///< rows of linear constraints are set once
  Matrix Phi_q_transposed_;
  Vector second_derivative_;  ///< m; stays zero for linear constraints without a driver
};

}  // namespace mbs::starting_dense
