// What the schemes have in common: M and the residual, over the constraints and forces.
#pragma once

#include <armadillo>

#include "constraints.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::armadillo_dense {

/// Throws Unsupported if a dense matrix of `model` in this scheme would take more than 2 GiB.
void require_storable(const Model& model, Scheme scheme);

/// The model lowered to flat arrays and a dense M, with the workspace of Phi and Phi_q. The linear
/// system of each scheme derives from it. T0 = M + (Δt/2) C + h K is not stored.
/// Positions x, velocities v and accelerations a are extended vectors (see Layout), at q', v', a'.
class Assembly {
 public:
  Assembly(const Model& model, const StepSettings& settings);
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  [[nodiscard]] const Layout& layout() const { return layout_; }

  [[nodiscard]] bool is_driven() const { return !drivers_.empty(); }
  /// Takes the values of all drivers at time t (s), those of driven points into x, v and a.
  void drive(double t, arma::vec& x, arma::vec& v, arma::vec& a);

  /// Evaluates Phi and Phi_q at x; what follows uses them.
  void evaluate(const arma::vec& x) { constraints_.evaluate(x); }

 protected:
  /// rhs (n) = -f of Eq. (3) with mu (m) in place of lambda + alpha Phi. Evaluates
  /// the forces, and with them C and K, which what follows uses.
  void negative_residual(const arma::vec& x, const arma::vec& v, const arma::vec& a,
                         const arma::vec& mu, arma::vec& rhs);
  /// out (m) = the first and the second derivative of Phi, with Phi_q of the last evaluate().
  void rates(const arma::vec& v, arma::vec& out) const;
  void accelerations(const arma::vec& v, const arma::vec& a, arma::vec& out) const;

  Layout layout_;
  arma::blas_int n_, m_;
  double h_;  ///< Δt²/4, s²
  Constraints constraints_;
  Drivers drivers_;
  Forces forces_;

  arma::mat M_;         ///< n x n, lower triangle
  arma::vec scaled_Q_;  ///< n, h Q without forces_
};

}  // namespace mbs::armadillo_dense
