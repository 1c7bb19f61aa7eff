// Dense storage of the model, and Phi, Phi_q, residual and tangent computed over it.
#pragma once

#include <armadillo>
#include <array>
#include <vector>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::armadillo_dense {

/// The model lowered to flat arrays and dense matrices, with the workspace of Phi and Phi_q.
///
/// Positions and velocities are passed as *extended* vectors: the n entries of q (or v), then
/// `dimension` constants for each fixed point, so that a fixed point is read like a free one. What
/// would be its columns of Phi_q is written to a scrap place behind the matrix.
///
/// Example, planar: A fixed, B free, one distance A-B. Positions are (Bx, By, Ax, Ay), and Phi_qᵀ
/// is the column (-2 (Ax - Bx), -2 (Ay - By)); the entries of A go to the scrap place.
class Assembly {
 public:
  Assembly(const Model& model, const StepSettings& settings);
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  /// Extended vectors with their constants set: points at t = 0, and zeros.
  [[nodiscard]] const arma::vec& initial_positions() const { return initial_positions_; }
  [[nodiscard]] arma::vec zero_velocities() const {
    return arma::vec(initial_positions_.n_elem, arma::fill::zeros);
  }

  /// Evaluates Phi and Phi_q at extended `positions`; what follows uses them.
  void evaluate(const arma::vec& positions);
  /// Phi (m) of the last evaluate().
  [[nodiscard]] const arma::vec& phi() const { return phi_; }

  /// rhs (n) = -f of Eq. (3), with a (n) = a' and mu (m) = lambda + alpha Phi.
  void negative_residual(const arma::vec& a, const arma::vec& mu, arma::vec& rhs) const;
  /// Lower triangle of T (n x n) by Eq. (5); the rest of T is overwritten too.
  void tangent(arma::mat& T) const;
  /// Right-hand sides (n) of Eq. (6); the second needs the extended velocities v' of the first.
  void velocity_projection(const arma::vec& v, arma::vec& rhs) const;
  void acceleration_projection(const arma::vec& velocities, const arma::vec& a, arma::vec& rhs);

 private:
  /// |r_a - r_b|² - value: the dot constraint with a = c, b = d.
  struct Distance {
    int row;
    int a, b;                    ///< of the points, in extended vectors
    arma::uword grad_a, grad_b;  ///< of the Jacobian entries, in jacobian_
    double value;
  };
  /// Any other dot constraint; its gradient at a point is w_cd (r_c - r_d) + w_ab (r_a - r_b).
  struct Dot {
    struct Gradient {
      arma::uword at;  ///< in jacobian_; unused ones are at the scrap place
      double w_cd, w_ab;
    };
    int row;
    int a, b, c, d;  ///< of the points, in extended vectors
    std::array<Gradient, 4> gradients;
    double value;
  };
  struct Linear {
    int row;
    int first, last;  ///< range of terms_
    double value;
  };

  void lower_points(const Model& model);
  void lower_dot_constraints(const Model& model);
  void lower_linear_constraints(const Model& model);
  [[nodiscard]] Dot lower(const DotConstraint& constraint, int row) const;
  [[nodiscard]] arma::uword gradient_place(int start, int row) const;
  [[nodiscard]] arma::uword scrap_place() const { return arma::uword(n_) * arma::uword(m_); }

  template <int dimension>
  void evaluate_dots(const double* x);
  template <int dimension>
  void evaluate_dot_accelerations(const double* v);

  arma::blas_int n_, m_;
  arma::blas_int dots_;  ///< the first dots_ rows of Phi vary; the others are linear
  int dimension_;
  double h_;      ///< Δt²/4, s²
  double alpha_;  ///< penalty factor

  std::vector<int> starts_;  ///< of each point in extended vectors
  arma::vec initial_positions_;
  std::vector<Distance> distances_;
  std::vector<Dot> others_;
  std::vector<Linear> linears_;
  std::vector<LinearConstraint::Term> terms_;

  arma::mat M_;         ///< n x n, lower triangle
  arma::mat T0_;        ///< n x n, lower triangle: the constant part of T
  arma::vec scaled_Q_;  ///< n, h Q
  arma::vec jacobian_;  ///< Phi_qᵀ (n x m, column-major, zeros written once), then the scrap place
  arma::vec phi_;       ///< m
  arma::vec gamma_;     ///< dots_, the derivative of Phi_q times v'
};

}  // namespace mbs::armadillo_dense
