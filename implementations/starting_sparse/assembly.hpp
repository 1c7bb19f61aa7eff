// Dense Jacobian and tangent matrix in coordinate format: storage, Eqs. (3), (5), (7) and (8).
#pragma once

#include <span>
#include <vector>

#include "mbs/model.hpp"
#include "solver.hpp"

namespace mbs::starting_sparse {

/// Coordinates and velocities come *extended*: the n variables, then the coordinates of the fixed
/// points (their velocity is zero), so that no loop asks whether a point is fixed.
class Assembly {
 public:
  /// `weight` is Delta t^2 / 4 (s^2), `penalty` is alpha.
  /// Throws Unsupported if the dense Jacobian or the coordinate list would take over 1 GiB.
  Assembly(const Model& model, double weight, double penalty);

  [[nodiscard]] int variables() const { return variables_; }
  /// The coordinates that follow the n variables in an extended vector.
  [[nodiscard]] std::span<const double> fixed_coordinates() const { return fixed_; }
  /// Lower triangle of T with duplicates: the entries of M, then those of weight alpha Phi_q'
  /// Phi_q.
  [[nodiscard]] CoordinateMatrix tangent() const { return {variables_, rows_, columns_, values_}; }

  /// Evaluates Phi and Phi_q at q (extended, m).
  void evaluate(const double* q);
  /// Phi (m) at the last evaluation.
  [[nodiscard]] std::span<const double> phi() const { return phi_; }
  /// False if a coordinate at the last evaluation was too large or not a number.
  [[nodiscard]] bool is_finite() const;

  /// right (n) = -f, Eq. (3), for accelerations a (n) and multipliers lambda (m).
  void residual(const double* a, const double* lambda, double* right);
  /// Writes weight alpha Phi_q' Phi_q of Eq. (5) behind the entries of M.
  void assemble();
  /// right (n) = M v.
  void project_velocity(const double* v, double* right) const;
  /// right (n) = M a - weight alpha Phi_q' (dPhi_q/dt v), for a (n) and v (extended).
  void project_acceleration(const double* a, const double* v, double* right);

 private:
  /// r_a - r_b at `a` and `b` of an extended vector; derivatives go to `to_a`, `to_b` of jacobian_.
  struct Distance {
    int row, a, b, to_a, to_b;
    double value;
  };
  struct Dot {
    int row, a, b, c, d, to_a, to_b, to_c, to_d;
    double value;
  };

  void number_points(const Model& model);
  void require_memory(const Model& model) const;
  void append_mass(const Model& model);
  void append_dot(int row, const DotConstraint& constraint);
  void append_linear(int row, const LinearConstraint& constraint);
  void append_row(int row, std::vector<int>& columns, bool is_constant);

  template <int kDimension>
  void evaluate_dots(const double* q);
  template <int kDimension>
  void evaluate_derivative(const double* v);
  void multiply_mass(const double* x, double* y) const;
  void add_transposed_product(int row_count, double* y) const;

  int variables_ = 0, constraints_ = 0, dimension_ = 0, dot_count_ = 0;
  double weight_ = 0.0, penalty_ = 0.0;
  std::vector<int> point_offset_;  // of each point in an extended vector
  std::vector<double> fixed_;
  std::span<const double> force_;  // Q

  std::vector<Distance> distances_;
  std::vector<Dot> dots_;
  std::span<const LinearConstraint> linear_;
  std::vector<double> phi_;
  std::vector<double> multiplier_;  // m; what the next Phi_q' is multiplied with

  // Phi_q, m x stride_, the gradient of one constraint after the other. The `dimension` columns
  // behind the n true ones take what is written for fixed points and are never read.
  int stride_ = 0;
  std::vector<double> jacobian_;
  // Structural non-zeros of Phi_q by row: [row_start_[i], row_start_[i + 1]) of the next two.
  std::vector<int> row_start_, nonzero_place_, nonzero_column_;

  // T: mass_count_ entries of M, the n diagonal ones first, then the products.
  int mass_count_ = 0;
  std::vector<int> rows_, columns_;
  std::vector<double> values_;
  // Product k, jacobian_[left_[k]] jacobian_[right_[k]], is entry mass_count_ + k of T.
  std::vector<int> left_, right_;
};

}  // namespace mbs::starting_sparse
