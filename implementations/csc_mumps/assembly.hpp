// Phi, Phi_q, M and T in compressed sparse columns, with everything symbolic done at construction.
#pragma once

#include <span>
#include <vector>

#include "mbs/model.hpp"
#include "solver.hpp"

namespace mbs::csc_mumps {

/// Vectors named `..._extended` hold the n variables and behind them `dimension` numbers for each
/// fixed point: its coordinates in q, zeros in v. So all points are alike to the loops.
class Assembly {
 public:
  /// `quarter` = Delta t^2 / 4 (s^2).
  Assembly(const Model& model, double quarter, double penalty);

  [[nodiscard]] const LowerPattern& pattern() const { return pattern_; }
  /// Values of the lower triangle of T on pattern(); never moves.
  [[nodiscard]] std::span<double> tangent() { return tangent_; }
  [[nodiscard]] std::span<const double> fixed_coordinates() const { return fixed_coordinates_; }

  /// Phi (m) and Phi_q at `q_extended`.
  void evaluate_constraints(const double* q_extended);
  [[nodiscard]] const double* phi() const { return phi_.data(); }

  /// T, Eq. (5), for the Phi_q evaluated last. False if T has a NaN or an infinity.
  [[nodiscard]] bool evaluate_tangent();

  /// right (n) = -f, Eq. (3).
  void newton_right(const double* acceleration, const double* lambda, double* right);
  /// right (n) = M v*, Eq. (6).
  void velocity_right(const double* velocity, double* right) const;
  /// right (n) = M a* - quarter alpha Phi_q' (dPhi_q/dt v), Eq. (6).
  void acceleration_right(const double* acceleration, const double* v_extended, double* right);

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
  /// How the derivative at one of the distinct free points of a dot constraint comes about:
  /// of_second (r_c - r_d) + of_first (r_a - r_b), factors 0, 1 or -1.
  struct Gradient {
    double of_second, of_first;
  };
  static constexpr int kPointsOfDot = 4;

  class Builder;

  template <int kDimension>
  void evaluate_constraints_in(const double* q);
  template <int kDimension>
  void evaluate_weights_in(const double* v);
  void multiply_mass(const double* x, double* y) const;

  int variables_ = 0, dimension_ = 0;
  double quarter_ = 0.0, penalty_ = 0.0;
  std::span<const double> force_;
  std::vector<double> fixed_coordinates_;

  std::vector<Distance> distances_;
  std::vector<Dot> dots_;
  std::vector<Gradient> gradients_;  // kPointsOfDot a dot constraint
  // Linear constraint i is row linear_row_ + i of Phi, its terms are those in
  // [linear_start_[i], linear_start_[i + 1]).
  int linear_row_ = 0;
  std::vector<int> linear_start_;
  std::vector<LinearConstraint::Term> linear_terms_;
  std::vector<double> linear_value_;
  std::vector<double> phi_;
  std::vector<double> weights_;  // m; what the columns of Phi_q are multiplied with

  // Phi_q by columns. write_order_ lists the places in jacobian_ in the order in which evaluation
  // writes them; the entry behind the last true one takes what nobody wants (fixed points).
  std::vector<int> column_start_, row_;
  std::vector<double> jacobian_;
  std::vector<int> write_order_;

  LowerPattern mass_pattern_;
  std::vector<double> mass_;

  // T = constant_ + quarter alpha update_, all three on pattern_. Entry target_[t] of update_ is
  // the sum of jacobian_[left_[k]] jacobian_[right_[k]] over k in [product_start_[t],
  // product_start_[t + 1]). Linear constraints are in constant_.
  LowerPattern pattern_;
  std::vector<double> constant_, update_, tangent_;
  std::vector<int> target_, product_start_, left_, right_;
};

}  // namespace mbs::csc_mumps
