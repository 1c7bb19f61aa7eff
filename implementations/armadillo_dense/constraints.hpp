// The constraints, lowered to flat arrays: Phi, Phi_q and the derivative of Phi_q times v.
#pragma once

#include <armadillo>
#include <array>
#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"

namespace mbs::armadillo_dense {

/// Owns Phi and Phi_qᵀ. The rows of Phi that vary with q (dot, then bilinear constraints) come
/// first; those of linear constraints are written once. Driven points have columns in Phi_q too,
/// behind those of q. What would be the columns of a fixed point is written to a scrap place behind
/// the matrix, so that no loop branches on it.
///
/// Example, planar: A fixed, B free, one distance A-B. Positions are (Bx, By, Ax, Ay), and Phi_qᵀ
/// is the column (-2 (Ax - Bx), -2 (Ay - By)); the entries of A go to the scrap place.
class Constraints {
 public:
  Constraints(const Model& model, const Layout& layout);

  /// Evaluates Phi and Phi_q at extended positions x.
  void evaluate(const arma::vec& x);
  /// Evaluates Phi alone.
  void evaluate_phi(const arma::vec& x);
  /// Phi (m) of the last evaluate() or evaluate_phi().
  [[nodiscard]] const arma::vec& phi() const { return phi_; }
  /// Phi_qᵀ (n x m, in columns of height layout.moving) of the last evaluate().
  [[nodiscard]] const double* jacobian() const { return jacobian_.memptr(); }
  /// How many rows of Phi vary; they are the first ones.
  [[nodiscard]] int quadratics() const { return quadratics_; }

  /// out (m) = Phi_q x, with an extended x and Phi_q of the last evaluate().
  void multiply(const arma::vec& x, arma::vec& out) const;
  /// out (m) += the derivative of Phi_q times v, with extended velocities v.
  void add_accelerations(const arma::vec& v, arma::vec& out) const;
  /// s of each constraint (m); drivers overwrite theirs.
  [[nodiscard]] arma::vec& values() { return values_; }

 private:
  /// |r_a - r_b|² - s: the dot constraint with a = c, b = d.
  struct Distance {
    int row;
    int a, b;                    ///< of the points, in extended vectors
    arma::uword grad_a, grad_b;  ///< of the Jacobian entries, in jacobian_
  };
  /// Entries of the Jacobian at one point: w_cd (B) (r_c - r_d) + w_ab (Bᵀ) (r_a - r_b).
  struct Gradient {
    arma::uword at;  ///< in jacobian_; unused ones are at the scrap place
    double w_cd, w_ab;
  };
  /// Any other dot constraint.
  struct Dot {
    int row;
    int a, b, c, d;  ///< of the points, in extended vectors
    std::array<Gradient, 4> gradients;
  };
  struct Bilinear {
    Dot dot;
    std::array<std::array<double, 3>, 3> B;
  };
  /// Where a row that varies has its entries at one free or driven point.
  struct Block {
    int row, start;
  };
  struct Linear {
    int row;
    int first, last;  ///< range of terms_
  };

  void lower_dot_constraints(const Model& model);
  void lower_bilinear_constraints(const Model& model);
  void lower_linear_constraints(const Model& model);
  [[nodiscard]] Dot lower(const std::array<int, 4>& points, int row);
  [[nodiscard]] arma::uword gradient_place(int start, int row);
  [[nodiscard]] arma::uword place(int row) const { return height_ * arma::uword(row); }
  [[nodiscard]] arma::uword scrap_place() const { return height_ * phi_.n_elem; }

  template <int dimension>
  void write_gradients(const Dot& c, const std::array<double, dimension>& u,
                       const std::array<double, dimension>& w);
  template <bool with_jacobian>
  void evaluate_rows(const arma::vec& x);
  template <int dimension, bool with_jacobian>
  void evaluate_dots(const double* x);
  template <int dimension, bool with_jacobian>
  void evaluate_bilinears(const double* x);
  template <int dimension>
  void multiply(const double* x, double* out) const;
  template <int dimension>
  void add_accelerations(const double* v, double* out) const;

  const Layout& layout_;
  arma::uword height_;  ///< of a column of Phi_qᵀ
  int quadratics_;
  std::vector<Distance> distances_;
  std::vector<Dot> others_;
  std::vector<Bilinear> bilinears_;
  std::vector<Block> blocks_;
  std::vector<Linear> linears_;
  std::vector<LinearConstraint::Term> terms_;
  arma::vec values_;    ///< m
  arma::vec phi_;       ///< m
  arma::vec jacobian_;  ///< Phi_qᵀ (zeros written once), then the scrap place
};

}  // namespace mbs::armadillo_dense
