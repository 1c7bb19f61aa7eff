// Constraints, forces, mass and energy of a Model in plain double: how the harness judges a state.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// One structural entry of Phi_q; its value may happen to be zero at some q.
struct JacobianEntry {
  int row = 0, col = 0;
  double value = 0.0;
};

// In all of these t is the time (s), q and v hold model.variables() entries, and every span must
// have the size stated (std::invalid_argument otherwise). A NaN or infinity in the input reaches
// every result that depends on it. Equations as numbered in paper/README.md.

/// Phi(q, t) of Eqs. (7) and (8) into `phi` (constraints()).
void evaluate_constraints(const Model& model, double t, std::span<const double> q,
                          std::span<double> phi);

/// Phi' = Phi_q v + Phi_t into `rate` (constraints()).
void constraint_rate(const Model& model, double t, std::span<const double> q,
                     std::span<const double> v, std::span<double> rate);

/// Phi_q(q, t), sorted by row then column, each structural position once: a quadratic constraint
/// has `dimension` entries for each distinct free point it names, a linear one an entry a term.
std::vector<JacobianEntry> jacobian(const Model& model, double t, std::span<const double> q);

/// The part of Phi'' that is free of a, (Phi_q)' v + (Phi_t)', into `curvature` (constraints()).
void constraint_curvature(const Model& model, double t, std::span<const double> q,
                          std::span<const double> v, std::span<double> curvature);

/// Q(q, v, t): constant force, springs and dampers, laws, couples, driven mass, into `force`
/// (variables()).
void applied_force(const Model& model, double t, std::span<const double> q,
                   std::span<const double> v, std::span<double> force);

/// Where a torsion spring, torque law or constant torque is within what Eqs. (11) and (18) mean.
struct Torsion {
  std::string name = {};
  double twist = 0.0;        ///< s in -pi ... pi
  double tilt = 0.0;         ///< largest |cosine| between its axis and what it turns; planar: 0
  bool can_turn_on = false;  ///< half a turn makes no difference: it depends on the rate alone
};
/// One for each torsion spring, then one for each torque law, then one for each constant torque.
std::vector<Torsion> torsions(const Model& model, double t, std::span<const double> q);

/// M_ii (n), kg.
std::vector<double> mass_diagonal(const Model& model);

/// M x into `y` (variables()).
void mass_times(const Model& model, std::span<const double> x, std::span<double> y);

/// Kinetic energy v.M v / 2, J; what driven points add is left out.
double kinetic_energy(const Model& model, std::span<const double> v);

/// Potential energy of the constant force, which is zero at q = 0, of the springs, and of laws
/// whose factor is constant (integral()), J.
double potential_energy(const Model& model, double t, std::span<const double> q);

/// Kinetic plus potential energy, J.
double energy(const Model& model, double t, std::span<const double> q, std::span<const double> v);

/// Whether a point or a row follows a function of time.
bool is_driven(const Model& model);

/// Whether kinetic plus potential energy is constant: no damper, couple or driver, no law over a
/// rate or with a factor of time.
bool is_conservative(const Model& model);

}  // namespace mbs
