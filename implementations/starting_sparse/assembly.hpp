// Dense Jacobian and tangent matrix in coordinate format: storage, Eqs. (3), (5), (7) and (8).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "drivers.hpp"
#include "forces.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::starting_sparse {

/// Coordinates and velocities come *extended*: the n variables, then the coordinates of the fixed
/// points (their velocity is zero unless driven), so that no loop asks whether a point is fixed.
class Assembly {
 public:
  /// Throws Unsupported if the dense Jacobian or the coordinate list would take over 1 GiB.
  Assembly(const Model& model, const StepSettings& settings);

  [[nodiscard]] int variables() const { return variables_; }
  /// The coordinates that follow the n variables in an extended vector.
  [[nodiscard]] std::span<const double> fixed_coordinates() const { return fixed_; }
  /// Lower triangle of T with duplicates: the entries of M, those of weight alpha Phi_q' Phi_q with
  /// weight = Delta t^2 / 4, then those of C and K.
  [[nodiscard]] CoordinateMatrix tangent() const { return {variables_, rows_, columns_, values_}; }

  /// False if the model has no driver and drive() need not be called.
  [[nodiscard]] bool is_driven() const { return !drivers_.empty(); }
  /// Takes the drivers' values at time t (s), those of driven points into q and v (extended).
  void drive(double t, double* q, double* v) { drivers_.drive(t, q, v, value_.data()); }

  /// Evaluates Phi and Phi_q at q (extended, m).
  void evaluate(const double* q);
  /// Phi (m) at the last evaluation.
  [[nodiscard]] std::span<const double> phi() const { return phi_; }
  /// False if a coordinate at the last evaluation and residual was too large or not a number.
  [[nodiscard]] bool is_finite() const;

  /// right (n) = -f, Eq. (3), at the evaluated q, for v (extended), a (n) and lambda (m).
  void residual(const double* q, const double* v, const double* a, const double* lambda,
                double* right);
  /// Writes what Eq. (5) adds to M behind the entries of M.
  void assemble();
  /// right (n) = that of Eq. (6) for v' - v*, at the last evaluation, with v* (n).
  void project_velocity(const double* v, double* right);
  /// The same for a' - a*, with v' (extended) and a* (n).
  void project_acceleration(const double* v, const double* a, double* right);

 private:
  /// r_a - r_b at `a` and `b` of an extended vector; derivatives go to `to_a`, `to_b` of jacobian_.
  struct Distance {
    int row, a, b, to_a, to_b;
  };
  struct Dot {
    int row, a, b, c, d, to_a, to_b, to_c, to_d;
  };
  struct Bilinear {
    Dot at;
    std::array<std::array<double, 3>, 3> B;
  };

  std::vector<int> number_points(const Model& model);
  void require_memory(const Model& model) const;
  void append_mass(const Model& model);
  void append_dot(int row, const DotConstraint& constraint);
  void append_bilinear(int row, const BilinearConstraint& constraint);
  void append_linear(int row, const LinearConstraint& constraint);
  [[nodiscard]] Dot locate(int row, int a, int b, int c, int d) const;
  void append_quadratic_row(const Dot& dot);
  void append_row(int row, std::vector<int>& columns, bool is_constant);

  template <int kDimension>
  void evaluate_dots(const double* q);
  template <int kDimension>
  void evaluate_bilinears(const double* q);
  template <int kDimension>
  void evaluate_derivative(const double* v);
  template <int kDimension>
  void evaluate_bilinear_derivative(const double* v);
  void multiply_mass(const double* x, double* y) const;
  void add_gradient(int row, double factor, double* y) const;
  void add_terms(std::span<const double> terms);
  void project(const double* x, double* right) const;

  int variables_ = 0, constraints_ = 0, dimension_ = 0;
  int quadratic_count_ = 0;  // of dot and bilinear constraints, the first rows of Phi
  double weight_ = 0.0, penalty_ = 0.0;
  std::vector<double> fixed_;
  std::vector<int> point_offset_;  // of each point in an extended vector
  Drivers drivers_;
  Forces forces_;
  std::span<const double> force_;  // Q without springs and couples

  std::vector<Distance> distances_;
  std::vector<Dot> dots_;
  std::vector<Bilinear> bilinears_;
  std::vector<double> value_;  // m; what each constraint subtracts, as last driven
  std::vector<double> phi_;
  std::vector<double> evaluated_;   // its q, extended; with drivers
  std::vector<double> multiplier_;  // m; what the next Phi_q' is multiplied with

  // Phi_q, m x stride_, the gradient of one constraint after the other. The `dimension` columns
  // behind the n true ones take what is written for fixed points and are never read.
  int stride_ = 0;
  std::vector<double> jacobian_;
  // Structural non-zeros of Phi_q by row: [row_start_[i], row_start_[i + 1]) of the next two.
  std::vector<int> row_start_, nonzero_place_, nonzero_column_;

  // T: mass_count_ entries of M, the n diagonal ones first, then the products, then the forces'.
  int mass_count_ = 0, forces_first_ = 0;
  std::vector<int> rows_, columns_;
  std::vector<double> values_;
  // Product k, jacobian_[left_[k]] jacobian_[right_[k]], is entry mass_count_ + k of T.
  std::vector<int> left_, right_;
};

}  // namespace mbs::starting_sparse
