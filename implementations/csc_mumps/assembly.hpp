// Phi, Phi_q, M and T in compressed sparse columns, with everything symbolic done at construction.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "drivers.hpp"
#include "forces.hpp"
#include "mbs/model.hpp"
#include "solver.hpp"

namespace mbs::csc_mumps {

/// Vectors named `..._extended` hold the n variables and behind them `dimension` numbers for each
/// fixed point (see ExtendedPoints): its coordinates in q, in v zeros or what drives it.
class Assembly {
 public:
  /// `step` = Delta t (s).
  Assembly(const Model& model, double step, double penalty);
  Assembly(const Assembly&) = delete;  // drivers_ knows where the values of constraints are
  Assembly& operator=(const Assembly&) = delete;

  [[nodiscard]] const LowerPattern& pattern() const { return pattern_; }
  /// Values of the lower triangle of T on pattern(); never moves.
  [[nodiscard]] std::span<double> tangent() { return tangent_; }
  [[nodiscard]] std::span<const double> fixed_coordinates() const { return fixed_coordinates_; }

  [[nodiscard]] bool is_driven() const { return !drivers_.empty(); }
  /// Takes the drivers' values at time t, those of driven points into q and v.
  void drive(double t, double* q_extended, double* v_extended) {
    drivers_.sample(t, q_extended, v_extended);
  }

  /// Phi (m) and Phi_q at `q_extended`.
  void evaluate_constraints(const double* q_extended);
  [[nodiscard]] const double* phi() const { return phi_.data(); }

  /// right (n) = -f, Eq. (3), for the Phi and Phi_q evaluated last. Evaluates the forces.
  void newton_right(const double* q_extended, const double* v_extended, const double* acceleration,
                    const double* lambda, double* right);
  /// T, Eq. (5), for the Phi_q and forces evaluated last. False if T has a NaN or an infinity.
  [[nodiscard]] bool evaluate_tangent();

  /// right (n) = that of v' in Eq. (6), from v* and Phi_q, Phi_t at q.
  void velocity_right(const double* q_extended, const double* velocity, double* right);
  /// right (n) = that of a' in Eq. (6), from a* and Phi_q, dPhi_q/dt v + dPhi_t/dt at q, v.
  void acceleration_right(const double* q_extended, const double* v_extended,
                          const double* acceleration, double* right);

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
  void evaluate_weights(const double* v);
  template <int kDimension>
  void evaluate_weights_in(const double* v);
  void multiply_mass(const double* x, double* y) const;
  void subtract_reaction(double* right) const;

  int variables_ = 0, dimension_ = 0;
  double quarter_ = 0.0, penalty_ = 0.0;
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
  std::vector<double> weights_;  // m; what the columns of Phi_q are multiplied with

  // Phi_q by columns. write_order_ lists the places in jacobian_ in the order in which evaluation
  // writes them; the entry behind the last true one takes what nobody wants (fixed points).
  std::vector<int> column_start_, row_;
  std::vector<double> jacobian_;
  std::vector<int> write_order_;

  LowerPattern mass_pattern_;
  std::vector<double> mass_;

  // T = constant_ + quarter alpha update_ (+ forces), all three on pattern_. Entry target_[t] of
  // update_ is the sum of jacobian_[left_[k]] jacobian_[right_[k]] over k in [product_start_[t],
  // product_start_[t + 1]). Linear constraints are in constant_.
  LowerPattern pattern_;
  std::vector<double> constant_, update_, tangent_;
  std::vector<int> target_, product_start_, left_, right_;

  Forces forces_;
  Drivers drivers_;
};

}  // namespace mbs::csc_mumps
