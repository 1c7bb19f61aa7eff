// Constraints, Jacobian, mass and energy of a Model in plain double: how the harness judges a
// state.
#pragma once

#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// One structural entry of Phi_q; its value may happen to be zero at some q.
struct JacobianEntry {
  int row = 0, col = 0;
  double value = 0.0;
};

// In all of these q and v hold model.variables() entries, and every span must have the size stated
// (std::invalid_argument otherwise). A NaN or infinity in the input reaches every result that
// depends on it.

/// Phi(q) of Eqs. (7) and (8) into `phi` (constraints()).
void evaluate_constraints(const Model& model, std::span<const double> q, std::span<double> phi);

/// Phi_q(q) v into `rate` (constraints()).
void constraint_rate(const Model& model, std::span<const double> q, std::span<const double> v,
                     std::span<double> rate);

/// Phi_q(q), sorted by row then column, each structural position once: a dot constraint has
/// `dimension` entries for each distinct free point it names, a linear one an entry a term.
std::vector<JacobianEntry> jacobian(const Model& model, std::span<const double> q);

/// The velocity-dependent part of Phi'', (Phi_q)' v, into `curvature` (constraints()).
void constraint_curvature(const Model& model, std::span<const double> v,
                          std::span<double> curvature);

/// M x into `y` (variables()).
void mass_times(const Model& model, std::span<const double> x, std::span<double> y);

/// Kinetic energy v.M v / 2, J.
double kinetic_energy(const Model& model, std::span<const double> v);

/// Mechanical energy v.M v / 2 - Q.q, J; the zero of the potential is at q = 0.
double energy(const Model& model, std::span<const double> q, std::span<const double> v);

}  // namespace mbs
