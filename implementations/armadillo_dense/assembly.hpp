// Dense matrices of the model: M, T and the right-hand sides, computed over Phi_q and the forces.
#pragma once

#include <armadillo>

#include "constraints.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::armadillo_dense {

/// Throws Unsupported if a dense matrix of `model` would take more than 2 GiB.
void require_storable(const Model& model);

/// The model lowered to flat arrays and dense matrices, with the workspace of Phi and Phi_q.
/// Positions x and velocities v are extended vectors (see Layout), at q' and v'.
class Assembly {
 public:
  Assembly(const Model& model, const StepSettings& settings);
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  [[nodiscard]] const Layout& layout() const { return layout_; }

  [[nodiscard]] bool is_driven() const { return !drivers_.empty(); }
  /// Takes the values of all drivers at time t (s), those of driven points into x and v.
  void drive(double t, arma::vec& x, arma::vec& v);

  /// Evaluates Phi and Phi_q at x; what follows uses them.
  void evaluate(const arma::vec& x) { constraints_.evaluate(x); }
  /// Phi (m) of the last evaluate().
  [[nodiscard]] const arma::vec& phi() const { return constraints_.phi(); }

  /// rhs (n) = -f of Eq. (3), with a (n) = a' and mu (m) = lambda + alpha Phi. Evaluates the
  /// forces, and with them C and K, which what follows uses.
  void negative_residual(const arma::vec& x, const arma::vec& v, const arma::vec& a,
                         const arma::vec& mu, arma::vec& rhs);
  /// Lower triangle of T (n x n) by Eq. (5); the rest of T is overwritten too.
  void tangent(arma::mat& T) const;
  /// Right-hand sides (n) of Eq. (6), v being v* in the first and v' in the second, a being a*.
  void velocity_projection(const arma::vec& x, const arma::vec& v, arma::vec& rhs);
  void acceleration_projection(const arma::vec& x, const arma::vec& v, const arma::vec& a,
                               arma::vec& rhs);

 private:
  void add_linear_constraints(const Model& model);
  /// rhs = [M + (Δt/2) C + h K] x, with the first n entries of x.
  void mass_product(const arma::vec& x, arma::vec& rhs) const;
  /// rhs -= h α Φqᵀ time_terms_.
  void subtract_time_terms(arma::vec& rhs) const;

  Layout layout_;
  arma::blas_int n_, m_;
  double h_;      ///< Δt²/4, s²
  double alpha_;  ///< penalty factor
  Constraints constraints_;
  Drivers drivers_;
  Forces forces_;

  arma::mat M_;         ///< n x n, lower triangle
  arma::mat T0_;        ///< likewise, M + h α Φqᵀ Φq of linear constraints; empty without them
  arma::vec scaled_Q_;  ///< n, h Q without forces_
  arma::vec time_terms_;  ///< of the rows that can be nonzero: Φt, then Φ̇q v' + Φ̇t
};

}  // namespace mbs::armadillo_dense
