// Consistent accelerations and multipliers of a model, and the conditioning of its constraints.
#pragma once

#include <span>

#include "mbs/simulation.hpp"

namespace mbs {

/// The state (q, v) at time t (s) completed by the a and lambda that solve Eq. (1) with Phi'' = 0:
///   M a + Phi_q^T lambda = Q,   Phi_q a = -(Phi_q' v + Phi_t').
/// Where constraints are redundant, lambda is the solution nearest to `lambda`, or to zero without.
State consistent_state(const Model& model, std::span<const double> q, std::span<const double> v,
                       double t = 0.0, std::span<const double> lambda = {});

/// consistent_state() at the model's initial position and velocity.
State initial_state(const Model& model);

/// Smallest eigenvalue above 0 of Phi_q M^-1 Phi_q^T at q and t = 0 (m^2/kg), to a few per cent;
/// infinity without constraints. It sets how fast the multiplier iteration contracts: what rows
/// that depend on each other add to it, eigenvalues of 0, no motion feels.
double smallest_constraint_eigenvalue(const Model& model, std::span<const double> q);

}  // namespace mbs
