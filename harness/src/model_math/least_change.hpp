// The smallest changes of coordinates or velocities that meet the constraints.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// Solves Phi_q x = right for the x of least x.M x, at one (q, t). Where rows of Phi_q depend on
/// each other and `right` does not fit, x fits in the sense of least squares. The cost is that of
/// one sparse factorization, linear for chains.
///
/// [Levenberg, 1944] K. Levenberg, A method for the solution of certain non-linear problems in
/// least squares, Quart. Appl. Math. 2, 164-168.
class LeastChange {
 public:
  /// M counts as diag(weights) M diag(weights) (n; empty: all 1); an infinite weight keeps x = 0.
  /// With a `damping` above 0, x minimises x.M x + sum of (squared residual k) / (damping * own k) instead, where own k is
  /// the diagonal of Phi_q M^-1 Phi_q^T with the diagonal of M [Levenberg, 1944]: steps then stay
  /// short where Phi_q is ill-conditioned. Throws std::invalid_argument if Phi_q is not finite.
  LeastChange(const Model& model, double t, std::span<const double> q,
              const std::vector<double>& weights = {}, double damping = 0.0);
  ~LeastChange();
  LeastChange(const LeastChange&) = delete;
  LeastChange& operator=(const LeastChange&) = delete;

  /// x (n) for `right` (m).
  [[nodiscard]] std::vector<double> solve(std::span<const double> right) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace mbs
