// Phi, Phi_q, M and Q in compressed sparse columns, with everything symbolic done at construction.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "drivers.hpp"
#include "forces.hpp"
#include "mbs/model.hpp"
#include "pattern.hpp"

namespace mbs::csc_mumps {

/// All terms of the equations; what matrix they go into is another matter (Tangent,
/// SaddlePointMatrix). Vectors q and v hold the n variables and behind them `dimension` numbers for
/// each fixed point (see ExtendedPoints): its coordinates in q, in v zeros or what drives it.
class Assembly {
 public:
  /// `step` = Delta t (s).
  Assembly(const Model& model, double step);
  Assembly(const Assembly&) = delete;  // drivers_ knows where the values of constraints are
  Assembly& operator=(const Assembly&) = delete;

  [[nodiscard]] std::span<const double> fixed_coordinates() const { return fixed_coordinates_; }

  [[nodiscard]] bool is_driven() const { return !drivers_.empty(); }
  /// Takes the drivers' values at time t, those of driven points into q and v.
  void drive(double t, double* q, double* v) { drivers_.sample(t, q, v); }

  /// Phi (m) and Phi_q at q.
  void evaluate_constraints(const double* q);
  [[nodiscard]] std::span<const double> phi() const { return phi_; }
  /// Phi_q by columns; its linear rows, those from linear_row() on, are constant.
  [[nodiscard]] const ColumnPattern& jacobian_pattern() const { return jacobian_pattern_; }
  [[nodiscard]] std::span<const double> jacobian() const {
    return std::span(jacobian_).first(jacobian_pattern_.row.size());
  }
  [[nodiscard]] int linear_row() const { return linear_row_; }
  /// result (m) = the first derivative of Phi by time with v, the second with v and a: Phi_q v +
  /// Phi_t, Phi_q a + dPhi_q/dt v + dPhi_t/dt, at the q of evaluate_constraints().
  void first_derivative(const double* v, double* result) const;
  void second_derivative(const double* v, const double* a, double* result) const;

  /// right (n) = -(Delta t^2 / 4) (M a + Phi_q' weights - Q), with the Phi_q evaluated last.
  /// Evaluates the forces.
  void balance(const double* q, const double* v, const double* a, const double* weights,
               double* right);
  [[nodiscard]] const Forces& forces() const { return forces_; }
  /// right (n) = -factor Phi_q' weights (m).
  void react(double factor, const double* weights, double* right) const;

 private:
  /// Offsets of the two points in an extended vector; `row` of Phi.
  struct Distance {
    int first, second, row;
    double value;
  };
  /// Offsets of the four points.
  struct Dot {
    int a, b, c, d, row;
    double value;
  };
  /// The same with B in between.
  struct Bilinear : Dot {
    std::array<std::array<double, 3>, 3> B;
  };
  /// How the derivative at one of the distinct free points of a dot constraint comes about:
  /// of_second (r_c - r_d) + of_first (r_a - r_b), factors 0, 1 or -1. Bilinear: the same with
  /// B (r_c - r_d) and B' (r_a - r_b).
  struct Gradient {
    double of_second, of_first;
  };
  static constexpr int kPointsOfDot = 4;

  class Builder;

  template <int kDimension>
  void evaluate_constraints_in(const double* q);
  template <int kDimension>
  void evaluate_bilinear_in(const double* q, const int* place, const Gradient* gradient);
  void evaluate_linear(const double* q);
  template <int kDimension>
  void evaluate_squares(const double* v, double* result) const;
  void add_product(const double* x, double* result) const;  // result (m) += Phi_q x
  void multiply_mass(const double* x, double* y) const;

  int variables_ = 0, dimension_ = 0;
  double quarter_ = 0.0;  // Delta t^2 / 4
  std::span<const double> force_;
  std::vector<double> fixed_coordinates_;

  std::vector<Distance> distances_;
  std::vector<Dot> dots_;
  std::vector<Bilinear> bilinears_;
  std::vector<Gradient> gradients_;  // kPointsOfDot a dot constraint, then a bilinear one
  // Linear constraint i is row linear_row_ + i of Phi, its terms are those in
  // [linear_start_[i], linear_start_[i + 1]).
  int linear_row_ = 0;
  std::vector<int> linear_start_;
  std::vector<LinearConstraint::Term> linear_terms_;
  std::vector<double> linear_value_;
  std::vector<double> phi_;
  std::vector<double> evaluated_;  // its q, extended; with drivers

  // Phi_q by columns. write_order_ lists the places in jacobian_ in the order in which evaluation
  // writes them; the entry behind the last true one takes what nobody wants (fixed points).
  ColumnPattern jacobian_pattern_;
  std::vector<double> jacobian_;
  std::vector<int> write_order_;

  ColumnPattern mass_pattern_;
  std::vector<double> mass_;

  Forces forces_;
  Drivers drivers_;
};

}  // namespace mbs::csc_mumps
