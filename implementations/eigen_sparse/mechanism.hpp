// The model in the solver's numbering, its state, and what all schemes evaluate of them.
#pragma once

#include <optional>

#include "constraints.hpp"
#include "coordinates.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "mbs/simulation.hpp"

namespace mbs::eigen_sparse {

/// All vectors are in the solver's elimination order, rows in the order of Constraints; only get
/// and set translate.
struct Mechanism {
  Mechanism(const Model& model, Coordinates numbering);
  /// Makes `forces`, which write to a matrix of this layout.
  void add_forces(const Model& model, const Layout& layout, double step);
  /// Makes `held`: from now on the matrix has C and K as they were at the last hold().
  void add_held(const Model& model, const Layout& layout, double step);
  /// Takes C and K at q'. `scratch`: n.
  void hold(Vector& scratch);

  void set_state(const State& state);
  void get_state(State& state) const;

  /// q', v', a' by prediction over `step` (s) and Eq. (2); constraints are not evaluated.
  /// `scratch`: n.
  void predict(double step, Vector& scratch);
  /// Adds `delta` (n, m) to q' and what Eq. (2) makes of it to v' and a'; returns max |delta|.
  double correct(double step, const Vector& delta);

  /// result = Q (n, N) at q', v'.
  void applied_force(Vector& result);
  /// result = Q - M a' + Phi_q^T multiplier (n, N), with `multiplier` (m) negative as a rule.
  void unbalanced_force(const Vector& multiplier, Vector& result);
  /// Adds C and K to the values of the matrix that forces were made for.
  void add_to_tangent(double* values) const;
  /// result = [M + (dt/2) C + (dt^2/4) K] x (n) with C and K of the last matrix, Eq. (15).
  void multiply(const Vector& x, Vector& result);
  /// Phi, Phi_q and what drivers add to the two below at q'.
  void evaluate();
  /// result = Phi_t (m) at the q' of the last evaluate(), Eqs. (7) and (8).
  void rates(Vector& result) const;
  /// result = d/dt (Phi_q) v' + d/dt Phi_t (m) there, Eqs. (7) and (8).
  void accelerations(Vector& result) const;

  /// Those that have C and K of the last matrix.
  [[nodiscard]] const Forces& in_tangent() const { return held.empty() ? forces : held; }

  Coordinates coordinates;
  Constraints constraints;
  RowSparseMatrix mass;  // both triangles: row products need no scattered stores
  Vector force;          // the part of Q that holds for a whole step
  std::optional<Drivers> drivers;
  Forces forces;  // the rest of Q
  Forces held;    // those with C and K once more; empty: `forces` have what the matrix has

  Vector q, v;  // extended by fixed points
  Vector a, lambda;
};

/// Solves of a refinement at most: projections, velocities and accelerations of RATTLE.
inline constexpr int kMaxRefinements = 5;

/// max |x|; a NaN if there is one in it.
inline double largest_of(const Vector& x) { return x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>(); }

}  // namespace mbs::eigen_sparse
