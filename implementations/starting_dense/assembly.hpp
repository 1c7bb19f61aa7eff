// Phi, Phi_q, residual and tangent matrix, everything stored dense.
#pragma once

#include <array>
#include <vector>

#include "matrix.hpp"
#include "mbs/model.hpp"

namespace mbs::starting_dense {

/// Holds M, Q and the constraints, and evaluates them. With n variables and m constraints.
///
/// Coordinates and velocities are taken *extended*: the n entries of q (or v), then the constants
/// of the fixed points (or zeros). So a fixed point is addressed like a free one:
///
///   A fixed at (0, 7), B free, C free:  extended q = (Bx By Cx Cy | 0 7), A at 4, B at 0, C at 2.
class Assembly {
 public:
  explicit Assembly(const Model& model);

  /// Extended coordinates at t = 0; from entry n on they are constant.
  [[nodiscard]] const Vector& extended_position() const { return extended_position_; }

  /// Evaluates phi() and the Jacobian, both ways round, at `q` (extended, m).
  void evaluate(const Vector& q);
  /// Phi (m) at the coordinates of the last evaluate().
  [[nodiscard]] const Vector& phi() const { return phi_; }

  /// right (n) = M a + Phi_q^T multipliers - Q, with a (n, m/s^2) and multipliers (m, N/m).
  void residual(const Vector& a, const Vector& multipliers, Vector& right);
  /// result (n x n) = M + factor Phi_q^T Phi_q.
  void tangent(double factor, Matrix& result);
  /// right (n) = M x.
  void mass_times(const Vector& x, Vector& right) const { matmul(M_, x, right); }
  /// right (n) = M a - factor Phi_q^T (Phi_q_dot v), with a (n) and v (extended, m/s).
  void acceleration_right(const Vector& a, const Vector& v, double factor, Vector& right);

 private:
  /// What stays of Eq. (7): where the points are in extended coordinates, and which blocks of the
  /// Jacobian row its two differences go to.
  struct Dot {
    int a, b, c, d;
    int blocks_begin, blocks_end;
    double value;  ///< m^2
  };
  /// The entries at one free point: ab (r_a - r_b) + cd (r_c - r_d).
  struct Block {
    int coordinate;
    double ab, cd;
  };

  void add_dot(const Model& model, const DotConstraint& constraint, const std::vector<int>& at);
  void add_linear(const LinearConstraint& constraint, int row);
  void evaluate_dot(int row, const Vector& q);

  int dimension_;
  Matrix M_;
  Vector Q_;
  Vector extended_position_;

  std::vector<Dot> dots_;  ///< rows 0, 1, ... of Phi
  std::vector<Block> blocks_;
  std::vector<LinearConstraint::Term> terms_;  ///< of all linear rows, one row after another
  std::vector<int> terms_end_;                 ///< for each linear row
  Vector linear_values_;

  Vector phi_;
  Matrix Phi_q_;             ///< m x n; rows of linear constraints are set once
  Matrix Phi_q_transposed_;  ///< n x m
  Vector Phi_q_dot_v_;       ///< m; zero for linear constraints
  Vector product_;           ///< n
};

}  // namespace mbs::starting_dense
