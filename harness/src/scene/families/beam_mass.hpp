// The mass matrix of a flexible beam in the coordinates of its nodes.
#pragma once

#include <Eigen/Core>

namespace mbs {

struct BeamShape {
  int nodes = 3;          ///< evenly spaced, the ends among them
  double length = 1.0;    ///< m
  double mass = 1.0;      ///< kg, spread evenly along it
  double offset = 0.0;    ///< m, of the section's centre from the line of nodes, to its left
  double gyration = 0.0;  ///< m, the section's radius about its centre
};

/// M (2 nodes x 2 nodes, kg), x and y of the first node first; symmetric, positive definite and
/// full. The line of nodes is a natural cubic spline, which is what is left of cubic beam elements
/// when rotations of nodes that carry no couple are condensed out [Guyan, 1965]. With N_i its
/// cardinal functions of the arc length s and J a quarter turn, what lies at s, off the line by y,
/// is at r = sum (N_i I + y N_i' J) r_i, so that
///   M_ij = integral (N_i N_j + y^2 N_i' N_j') I + y (N_i N_j' - N_i' N_j) J dm.
/// Sections stay at right angles to the line for small stretch, M is the same in every direction.
Eigen::MatrixXd beam_mass(const BeamShape& beam);

}  // namespace mbs
